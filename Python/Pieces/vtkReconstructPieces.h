// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkReconstructPieces
 * @brief   the surface of more points than memory holds, piece by piece
 *
 * Private to the Python package, whose program makes surfaces larger than memory with it.
 *
 * A source that is given points by AddPoints(), part by part, and whose output is the piece of the
 * surface that is asked for, as by UpdatePiece(piece, numberOfPieces, 0) or by a writer of pieces.
 * Together the pieces have exactly the triangles that vtkGridDelaunay2D makes of all points at
 * once, whatever the number of pieces and the order of parts: also the lattice, and which of
 * duplicates is kept, are those of all.
 *
 * @par Pieces:
 * The plane is cut into a cell for each piece, with about as many points each. A piece has the
 * points of its cell, also unused ones, then the corners of its triangles that are points of other
 * pieces: these are marked in vtkGhostType as DUPLICATEPOINT. Global ids are those of the points
 * that are added, or, in GlobalPointIds, the place of each in the order of AddPoints(). Each
 * triangle is in one piece, that of its lowest corner if it reaches over the border of a cell.
 * Field data are those of vtkGridDelaunay2D, for this piece.
 *
 * @par Properties:
 * All properties of the triangulation are those of GetDelaunay(), and so are constraints. As those
 * of the other filters, they are brought up to date. MaximumElevationError, MaximumNumberOfPoints,
 * DrapeConstraints, RemoveUnusedPoints and OutputPointsPrecision are for points in memory, and are
 * errors. Where GetTrim() has a boundary, all pieces are trimmed along it, as that filter would
 * trim the whole surface; with TrimOutward on and no boundary, along the outline that it would
 * find. Where only the whole surface would show the outline, as of some surveys along lines, there
 * is an error. Points that constraints add get ids after the largest, and points that trimming
 * inserts after those. OutwardTest InwardNormal is an error. Next to points that trimming inserts,
 * diagonals may differ from those of that filter, as they do with that filter for triangles in
 * another order.
 *
 * With FillHoles on, holes are filled as GetFill() would fill them in the whole surface: their
 * patches are the same to the last bit, and go to the piece with the first point of the rim.
 * Where MaximumNumberOfInsertedPoints has room for one of two holes of the same need, it may be the
 * other one.
 * Output 1, of piece 0, has the outline and the report of each hole, as output 1 of that filter.
 *
 * @par Ranks:
 * Where the controller has several processes, each of them adds its own points, maybe none, and
 * makes its own pieces: of n pieces, which have to be a multiple of p processes, process r makes
 * [r n / p, (r + 1) n / p). Ids count the points of process 0 first, then those of process 1 and so on;
 * counts are those of all. Boundary and constraints may be on any of them. They wait for each other
 * when each asks for its first piece, and only then: what one of them has wrong, or an abort, is
 * then that of all, and process 0 reports it. After such an error, properties have to be changed,
 * or Modified() be called, on all processes. Each needs a Folder of its own.
 *
 * @par Files, memory and time:
 * What is not worked on is in files in Folder. They take 32 bytes a point and the values of its
 * point arrays, and from the triangulation on 24 bytes more. Pieces can be asked for again until
 * the files are removed: by Reset(), with this object and, with KeepFiles off, piece by piece. The
 * first piece that is asked for decides on the number of pieces; it takes the time of the whole
 * triangulation, which is linear in the points. Memory is what a piece takes, some 250 bytes a
 * point of it; the seams of pieces, which it holds too, have some multiple of the square root of so
 * many points. To fill the holes of a piece takes the surface around them, mostly up to 1.5 times
 * the size of a hole away from it, and all outlines of the surface, some 400 bytes an edge.
 * Constraints take their lines, the points near them and the triangles that they cross.
 *
 * Points are float where all that are added are. While it works, the progress text names the step:
 * triangulating, trimming or filling holes.
 *
 * @par Errors:
 * A wrong property or call is an error that loses nothing. After an error of the work, such as a
 * full disk, or an abort, the output is empty, and only Reset() helps.
 *
 * @sa vtkGridDelaunay2D vtkTrimOutwardTriangles vtkFillElevationHoles
 */
#ifndef vtkReconstructPieces_h
#define vtkReconstructPieces_h

#include "vtkElevationSurfaceABI.h"
#include "vtkElevationSurfacePiecesModule.h" // For export macro
#include "vtkNew.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"

#include <memory>
#include <string>

namespace elevation
{
class ReconstructParts;
} // namespace elevation

VTK_ABI_NAMESPACE_BEGIN
class vtkFillElevationHoles;
class vtkGridDelaunay2D;
class vtkMultiProcessController;
class vtkPointSet;
class vtkStringArray;
class vtkTrimOutwardTriangles;

class VTKELEVATIONSURFACEPIECES_EXPORT vtkReconstructPieces : public vtkPolyDataAlgorithm
{
public:
  ///@{
  /** Standard VTK object functions. */
  static vtkReconstructPieces* New();
  vtkTypeMacro(vtkReconstructPieces, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}
  vtkMTimeType GetMTime() override; ///< the latest change, also of the three filters' properties

  ///@{
  /**
   * The folder of the temporary files: one that exists and is empty. There is no default. It is
   * taken with the first points.
   */
  virtual void SetFolder(const std::string& folder);
  virtual std::string GetFolder() { return this->Folder; }
  ///@}

  ///@{
  /**
   * Whether the files of a piece stay when it has been made, so that it can be asked for again. On
   * by default. Off, the space on disk does not grow while pieces are written.
   */
  vtkSetMacro(KeepFiles, bool);
  vtkBooleanMacro(KeepFiles, bool);
  ///@}

  ///@{
  /**
   * The processes that work together, each with points and pieces of its own. By default the global
   * controller; with nullptr this process works alone. It is taken with the first points.
   */
  virtual void SetController(vtkMultiProcessController* controller);
  virtual vtkMultiProcessController* GetController();
  ///@}

  ///@{
  /**
   * The filters whose properties control how to triangulate, trim and fill, and the boundary. Their
   * input 0 is not used.
   */
  vtkGridDelaunay2D* GetDelaunay();
  vtkTrimOutwardTriangles* GetTrim();
  vtkFillElevationHoles* GetFill();
  ///@}

  /**
   * Whether the surface is trimmed along its outline where no boundary is given. Off by default;
   * along a given boundary it is always trimmed.
   */
  virtual void SetTrimOutward(bool trim);

  /** Whether holes are filled. Off by default. */
  virtual void SetFillHoles(bool fill);

  /**
   * The memory, in bytes, that filling may take for one hole. Where more is expected for one, an
   * error names a Spacing that would do, before any is filled. 0 (default): no limit; negative
   * values are taken as 0.
   */
  virtual void SetHoleMemory(double bytes);

  /**
   * Adds points, with their point arrays; all parts need the same arrays. Of points with the same
   * global id one counts, and none that is marked in vtkGhostType as DUPLICATEPOINT.
   * @return whether it could be done; else there is an error
   */
  bool AddPoints(vtkPointSet* points);

  /** Forgets all points, and removes the files. */
  void Reset();

  ///@{
  /** Counts of all pieces; points can be counted before the first piece, the others after it. */
  vtkIdType GetNumberOfPoints();
  vtkIdType GetNumberOfTriangles();
  vtkIdType GetNumberOfDuplicatePoints();
  vtkIdType GetNumberOfNonFinitePoints();
  vtkIdType GetNumberOfConstraintCrossings();
  vtkIdType GetNumberOfAddedPoints(); ///< by constraints
  bool GetLatticeFound();
  ///@}

  ///@{
  /** As those of vtkTrimOutwardTriangles, of all pieces; 0 where the surface is not trimmed. */
  vtkIdType GetNumberOfTrimmedTriangles(); ///< what is left
  vtkIdType GetNumberOfOutwardTriangles();
  vtkIdType GetNumberOfRecoveredEdges();
  vtkIdType GetNumberOfPointsLeftOut();
  vtkIdType GetNumberOfInsertedPoints();
  double GetEffectiveGapTolerance();
  vtkIdType GetNumberOfBoundaryRings();
  ///@}

  ///@{
  /** As those of vtkFillElevationHoles, of all pieces; 0 where holes are not filled. */
  vtkIdType GetNumberOfHoles();
  vtkIdType GetNumberOfFilledHoles();
  vtkIdType GetNumberOfFilledTriangles(); ///< what there is with the patches
  ///@}

  /**
   * As of the three filters, but those of the last ErrorEvent or WarningEvent alone. Further codes
   * are HoleTooLarge, Aborted, TooFewPieces, TooFewPiecesToFill, ErrorNotInPieces,
   * NumberNotInPieces, ConstraintsNotInPieces, PointsWithoutZNotInPieces, InwardNormalNotInPieces,
   * UnusedPointsInPieces, PrecisionInPieces, BoundaryNotInPieces and OutlineNotInPieces.
   */
  virtual vtkStringArray* GetMessages() { return this->Messages; }

protected:
  vtkReconstructPieces();
  ~vtkReconstructPieces() override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkReconstructPieces(const vtkReconstructPieces&) = delete;
  void operator=(const vtkReconstructPieces&) = delete;
  vtkMTimeType TimeOfProperties();

  std::string Folder;
  vtkSmartPointer<vtkMultiProcessController> Controller;
  vtkNew<vtkGridDelaunay2D> Delaunay;
  vtkNew<vtkTrimOutwardTriangles> Trim;
  vtkNew<vtkFillElevationHoles> Fill;
  bool KeepFiles = true;
  bool TrimOutward = false;
  bool FillHoles = false;
  double HoleMemory = 0.0;
  vtkNew<vtkStringArray> Messages;
  std::unique_ptr<elevation::ReconstructParts> Parts;
};
VTK_ABI_NAMESPACE_END

#endif
