// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTextRows
 * @brief   the numbers of lines of text that are rows of a table and nothing else
 *
 * Private to the Python package, whose reader of text asks it first, and numpy where a block of
 * lines holds anything unusual. Numbers are the nearest doubles, as numpy's are.
 */
#ifndef vtkTextRows_h
#define vtkTextRows_h

#include "vtkElevationSurfaceABI.h"
#include "vtkElevationSurfacePiecesModule.h" // For export macro
#include "vtkObject.h"

#include <string>

VTK_ABI_NAMESPACE_BEGIN
class vtkDoubleArray;
class vtkIntArray;

class VTKELEVATIONSURFACEPIECES_EXPORT vtkTextRows : public vtkObject
{
public:
  ///@{
  /** Standard VTK object functions. */
  static vtkTextRows* New();
  vtkTypeMacro(vtkTextRows, vtkObject);
  ///@}

  /**
   * Reads lines with \n at their ends.
   * @param first      where in the text the first of them begins
   * @param separator  one character, or none where blanks and tabs part words
   * @param words      how many each line has
   * @param columns    the places of the wanted ones among them, each once
   * @param comments   no line begins with one of these characters
   * @param rows       gets a tuple for each line
   * @return whether all lines are such, and the wanted words finite decimal numbers. If not, rows
   *         are not valid
   */
  static bool Parse(const std::string& text, vtkIdType first, const std::string& separator,
    int words, vtkIntArray* columns, const std::string& comments, vtkDoubleArray* rows);

protected:
  vtkTextRows();
  ~vtkTextRows() override;

private:
  vtkTextRows(const vtkTextRows&) = delete;
  void operator=(const vtkTextRows&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
