// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Whether two meshes are the same.
 */
#ifndef SameMesh_h
#define SameMesh_h

#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>

/** Whether points and cells are equal, in the same order. */
inline bool AreSame(vtkPolyData* a, vtkPolyData* b)
{
  bool isSame = a->GetNumberOfPoints() == b->GetNumberOfPoints() &&
    a->GetNumberOfCells() == b->GetNumberOfCells();
  for (vtkIdType i = 0; isSame && i < a->GetNumberOfPoints(); ++i)
  {
    double p[3], q[3];
    a->GetPoint(i, p);
    b->GetPoint(i, q);
    isSame = std::equal(p, p + 3, q);
  }
  for (vtkIdType i = 0; isSame && i < a->GetNumberOfCells(); ++i)
  {
    vtkNew<vtkIdList> p, q;
    a->GetCellPoints(i, p);
    b->GetCellPoints(i, q);
    isSame = p->GetNumberOfIds() == q->GetNumberOfIds() &&
      std::equal(p->begin(), p->end(), q->begin());
  }
  return isSame;
}

#endif
