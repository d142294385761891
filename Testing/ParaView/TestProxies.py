# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Each proxy has every parameter of its class, with the same default, and hands it on."""
import os
import re
import xml.etree.ElementTree

from paraview import simple
from paraview.modules.vtkRemotingClientServerStream import vtkClientServerInterpreterInitializer

from plugin_testing import check, check_equal, finish, start

# For each property: a value other than the default.
OTHER_VALUES = {
    "GridDelaunay2D": {
        "SearchStrategy": "Compactness",
        "MaximumEdgeLength": 2.5,
        "MaximumElevationError": 0.5,
        "MaximumNumberOfPoints": 500,
        "DataDependentEdges": 1,
        "SimplifyConstraints": 1,
        "DrapeConstraints": 1,
        "DuplicatePolicy": "Keep Highest",
        "LatticeMode": "Off",
        "Lattice": [0.0, 0.0, 25.0, 0.0, 0.0, 25.0],
        "LatticeTolerance": 0.05,
        "RemoveUnusedPoints": 1,
        "OutputPointsPrecision": "Single",
        "NumberOfThreads": 2,
    },
    "TrimOutwardTriangles": {
        "OutwardTest": "Inward Normal",
        "GapTolerance": 3.5,
        "GridSteps": [5.0, 0.0, 0.0, 5.0],
        "RecoverBoundary": 0,
        "BoundaryEdges": "Straight",
        "RemoveUnusedPoints": 1,
        "OutputPointsPrecision": "Single",
        "NumberOfThreads": 2,
    },
    "FillElevationHoles": {
        "OpenEdgeLength": 1.5,
        "MaximumHoleSize": 12.5,
        "MaximumHoleEdges": 40,
        "AreaMode": "Keep Open",
        "LevelArrayName": "water",
        "FillCutOuts": 1,
        "MaximumNumberOfInsertedPoints": 5000,
        "MaximumNumberOfExpectedPoints": 4000,
        "Spacing": 0.25,
        "MatchDensity": 1,
        "Interpolation": "Thin Plate",
        "ConfidenceLevel": 0.8,
        "InterpolatePointData": 0,
        "RemoveUnusedPoints": 1,
        "OutputPointsPrecision": "Single",
        "NumberOfThreads": 2,
    },
}
OUTPUT_NAMES = {
    "GridDelaunay2D": 1,
    "TrimOutwardTriangles": ["Surface", "Outward Triangles", "Boundary"],
    "FillElevationHoles": ["Surface", "Hole Outlines"],
}


def printed(algorithm, name):
    """What PrintSelf says of a parameter. The plugin brings no Python wrappers to ask the getter."""
    match = re.search(r"^\s*%s: *(.*)$" % name, str(algorithm), re.MULTILINE)
    return match.group(1) if match else None


def members(header):
    """Names of the parameters of a class, and of its results after Update(), from its header."""
    parameters = set(re.findall(r"vtkSet\w*Macro\((\w+)", header))
    parameters |= set(re.findall(r"void Set(\w+)\([^)]+\)", header))
    # The second inputs, and the processes.
    others = {"BoundaryConnection", "BoundaryData", "SourceConnection", "SourceData", "AreasConnection",
              "AreasData", "LineConnection", "Controller"}
    parameters -= others | set(re.findall(r"Deprecated.*\*/\s*void Set(\w+)", header))
    results = set(re.findall(r"vtkGet\w*Macro\((\w+)|bool Get(\w+)\(\)", header))
    results = {one or other for one, other in results} - parameters - others
    return parameters, results


data_folder, _ = start()
plane = simple.Plane(XResolution=4, YResolution=4)
interpreter = vtkClientServerInterpreterInitializer.GetGlobalInterpreter()

for name, values in OTHER_VALUES.items():
    with open(os.path.join(os.path.dirname(data_folder), "Filters", "vtk%s.h" % name)) as header:
        parameters, results = members(header.read())
    check_equal(set(values), parameters, name + ": tested properties and parameters of the class")

    proxy = getattr(simple, name)(Input=plane)
    available = set(proxy.ListProperties())
    check(parameters <= available, "%s: no property for %s" % (name, parameters - available))
    check(results <= available, "%s: no property for %s" % (name, results - available))

    for each in sorted(parameters | results):
        documentation = proxy.SMProxy.GetProperty(each).GetDocumentation()
        text = (documentation.GetDescription() or "").strip() if documentation else ""
        check(len(text) > 20, "%s: %s is not documented" % (name, each))
    check(len((proxy.SMProxy.GetDocumentation().GetDescription() or "").strip()) > 100,
          name + " is not documented")

    # ParaView's defaults have been pushed to the object when the proxy was made.
    fresh = interpreter.NewInstance("vtk" + name)
    used = proxy.SMProxy.GetClientSideObject()
    for each in sorted(parameters):
        check(printed(fresh, each) is not None, "%s prints no %s" % (name, each))
        check_equal(printed(used, each), printed(fresh, each), "%s: default of %s" % (name, each))
    for each, value in values.items():
        setattr(proxy, each, value)
        proxy.SMProxy.UpdateVTKObjects()
        check(printed(used, each) != printed(fresh, each),
              "%s: %s does not reach the filter" % (name, each))

    names = OUTPUT_NAMES[name]
    count = proxy.SMProxy.GetNumberOfOutputPorts()
    if isinstance(names, int):
        check_equal(count, names, name + ": outputs")
    else:
        check_equal([proxy.SMProxy.GetOutputPortName(i) for i in range(count)], names,
                    name + ": outputs")

# The entries made of Python classes, and all properties as they are described.
from vtkelevationsurface.description import DESCRIBED, titled  # noqa: E402  (the plugin brings it)

chain = simple.ReconstructElevationSurface(Input=plane)
reader = simple.ElevationPoints()
for proxy in (chain, reader):
    name = type(proxy).__name__
    for each in proxy.ListProperties():
        documentation = proxy.SMProxy.GetProperty(each).GetDocumentation()
        text = (documentation.GetDescription() or "").strip() if documentation else ""
        check(len(text) > 10, "%s: %s is not documented" % (name, each))
FILTERS = {name: getattr(simple, name)(Input=plane) for name in OTHER_VALUES}
STEPS = dict(zip(("delaunay", "trim", "fill"), FILTERS.values()))
PROXIES = {"chain": lambda one: [chain], "reader": lambda one: [reader],
           "filter": lambda one: [STEPS[one.step]] if one.step in STEPS else list(STEPS.values())}
for one in DESCRIBED.values():
    for place in set(one.places) & set(PROXIES):
        if one.words["takes"] == "lines":
            continue
        for proxy in PROXIES[place](one):
            own = one.name_in(place)
            title = "%s of %s" % (own, type(proxy).__name__)
            entry = proxy.SMProxy.GetProperty(own)
            check(entry is not None, "there is no " + title)
            check_equal(entry.GetXMLLabel(), one.label_in(place), "label of " + title)
            text = " ".join(entry.GetDocumentation().GetDescription().split())
            check_equal(text, one.help_in(place), "words of " + title)
            visibility = "advanced" if place in one.words.get("advanced", "") else "default"
            check_equal(entry.GetPanelVisibility(), visibility, "visibility of " + title)
            if one.kind.value_type != "string":
                default = one.kind.numbers(one.default_in(place) or "0")
                has = [entry.GetElement(i) for i in range(entry.GetNumberOfElements())]
                check_equal(has, default, "default of " + title)
            domain = entry.GetDomain("enum")
            count = domain.GetNumberOfEntries() if domain else 0
            check_equal([domain.GetEntryText(i) for i in range(count)],
                        [titled(choice) for choice in one.choices], "choices of " + title)
            check_equal([domain.GetEntryValue(i) for i in range(count)], list(range(count)),
                        "numbers of the choices of " + title)

# What was used of a property is right below it.
for proxy in (chain, FILTERS["TrimOutwardTriangles"]):
    proxy = proxy.SMProxy
    groups = [proxy.GetPropertyGroup(i) for i in range(proxy.GetNumberOfPropertyGroups())]
    order = [group.GetProperty(i).GetXMLName() for group in groups for i in range(group.GetNumberOfProperties())]
    below = [(order[i - 1], order[i]) for i in range(len(order)) if order[i].startswith("Effective")]
    check_equal([one for one, _ in below], [name[len("Effective"):] for _, name in below], "what is below what")
    check_equal(len(below), 3 if proxy.GetXMLName() == chain.SMProxy.GetXMLName() else 1, "how many were used")

# The filters of the plugin's own, whose classes have no property described for others.
OF_PLUGIN = {
    "ElevationGrid": {"Dimensions": [30, 20]},
    "ElevationProfile": {"Point1": [1.0, 2.0, 3.0], "Point2": [4.0, 5.0, 6.0], "Resolution": 7},
}
for name, values in OF_PLUGIN.items():
    with open(os.path.join(os.path.dirname(data_folder), "Plugin", "Samples", "vtk%s.h" % name)) as header:
        check_equal(set(values), members(header.read())[0], name + ": tested properties and parameters of the class")
    proxy = getattr(simple, name)(Input=plane)
    for each, value in values.items():
        text = (proxy.SMProxy.GetProperty(each).GetDocumentation().GetDescription() or "").strip()
        check(len(text) > 20, "%s: %s is not documented" % (name, each))
        before = printed(proxy.SMProxy.GetClientSideObject(), each)
        setattr(proxy, each, value)
        proxy.SMProxy.UpdateVTKObjects()
        after = printed(proxy.SMProxy.GetClientSideObject(), each)
        check(None is not before != after, "%s: %s does not reach the filter" % (name, each))
    check(len((proxy.SMProxy.GetDocumentation().GetDescription() or "").strip()) > 100, name + " is not documented")

# The menu has all of them, in the order of the work.
menu = xml.etree.ElementTree.parse(os.path.join(os.path.dirname(data_folder), "Plugin", "Menu.xml"))
check_equal([entry.get("name") for entry in menu.iter("Proxy")],
            ["ReconstructElevationSurface", *OTHER_VALUES, *OF_PLUGIN], "entries of the menu")

finish()
