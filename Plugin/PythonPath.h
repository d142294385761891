// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PythonPath_h
#define PythonPath_h

// Puts the plugin's own folder on Python's path: the package vtkelevationsurface lies there. Works
// whether Python runs already or is started later.
void AddPackageToPythonPath();

#endif
