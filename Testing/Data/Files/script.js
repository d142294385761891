var CONTOUR = {
"type": "FeatureCollection",
"features": [
{ "type": "Feature", "properties": { "ELEV": -10.0 }, "geometry": { "type": "Point", "coordinates": [ 446218.35, 94998.9 ] } }
]
}
