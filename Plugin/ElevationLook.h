// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ElevationLook_h
#define ElevationLook_h

// Has ParaView find vtkSMElevationLook, which gives surfaces, points and lines their first look. The
// representations in ElevationSurface.xml.in name it as their initialization helper.
void ElevationLook();

#endif
