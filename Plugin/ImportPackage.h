// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ImportPackage_h
#define ImportPackage_h

// Puts the plugin's own folder on Python's path, where the package vtkelevationsurface lies, and imports
// the package. Where Python is not running yet, that is done when it starts.
// The import has to come early: VTK's wrappers remember for good which class they gave an object of a
// class that they did not know.
void ImportPackage();

#endif
