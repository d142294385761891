// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ChooseBackend_h
#define ChooseBackend_h

// Gives ParaView, whose VTK starts without threads, those of vtkSMPTools's backend STDThread. Who has set
// VTK_SMP_BACKEND_IN_USE has chosen already.
void ChooseBackend();

#endif
