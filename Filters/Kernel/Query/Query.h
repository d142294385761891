// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a finished surface answers: heights at places, and volumes against another surface.
 *
 * Where to begin: PlaceWeights.h, of which vertices a height at a place is made; Overlay.h, what lies
 * between two surfaces.
 */
#ifndef elevation_Query_Query_h
#define elevation_Query_Query_h

#include "Overlay.h"
#include "PlaceWeights.h"

#endif
