# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reading and reconstructing as VTK algorithms, for pipelines and for ParaView.

ElevationPoints reads what read() reads; ReconstructElevationSurface makes of its input what
reconstruct() makes of it. Both tell what they have done as text, and an error in one line.
"""

import re

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from .clouds import cells_of, set_crs
from .messages import ElevationSurfaceError
from .reading import read, read_boundary, read_faults
from .report import counted, crs_name

ELEVATION = "Elevation"


class Aborted(Exception):
    """The user wants no result any more."""


def in_panel(words):
    """A message with the names of options as a panel has them: --no-data 0 -> No Data 0."""
    return re.sub(
        r"--([a-z][a-z-]*)", lambda option: option.group(1).replace("-", " ").title(), words
    )


def set_elevation(data):
    """Adds z as the point array to colour by. Another array of this name gets another name."""
    z = numpy.ascontiguousarray(vtk_to_numpy(data.GetPoints().GetData())[:, 2])
    attributes = data.GetPointData()
    old = attributes.GetArray(ELEVATION)
    if old is not None:
        attributes.RemoveArray(ELEVATION)
        if old.GetNumberOfComponents() != 1 or not numpy.array_equal(vtk_to_numpy(old), z):
            kept = old.NewInstance()
            kept.DeepCopy(old)
            kept.SetName(f"{ELEVATION} of the input")
            attributes.AddArray(kept)
    array = numpy_to_vtk(z, deep=True)
    array.SetName(ELEVATION)
    attributes.SetScalars(array)


def set_words(data, name, lines):
    """Writes lines of text into a field array."""
    words = vtkStringArray()
    words.SetName(name)
    for line in lines:
        words.InsertNextValue(line)
    data.GetFieldData().AddArray(words)


class TellingAlgorithm(VTKPythonAlgorithmBase):
    """An algorithm that tells its user what it has done and why it cannot, each once."""

    def __init__(self, inputs, outputs):
        VTKPythonAlgorithmBase.__init__(
            self, nInputPorts=inputs, nOutputPorts=outputs, outputType="vtkPolyData"
        )
        self._told = self._text = ""

    def change(self, name, value):
        """Sets an attribute, and marks the output as out of date where it differs."""
        if getattr(self, name) != value:
            setattr(self, name, value)
            self.Modified()

    def RequestData(self, request, inInfo, outInfo):
        """Runs work(inInfo, outInfo), and tells its text or its error."""
        self._text = ""
        try:
            lines = self.work(inInfo, outInfo)
        except Aborted:
            return 1
        except MemoryError:
            return self.fail("there is not enough memory")
        except (ElevationSurfaceError, ValueError, TypeError) as error:
            return self.fail(in_panel(str(error)))
        self._text = "\n".join(lines)
        if self._text not in ("", self._told):
            vtkOutputWindow.GetInstance().DisplayText(self._text + "\n")
        self._told = self._text
        return 1

    def fail(self, words):
        """Reports an error as vtkErrorMacro() does. Returns what RequestData() is to return.

        That is success, with empty output. After a failure the executive would add lines that tell
        nothing, and ParaView would never update a picture of this output again.
        """
        self._report("ErrorEvent", "DisplayErrorText", "ERROR", words)
        self._told = ""
        return 1

    def warn(self, words):
        """Reports a warning as vtkWarningMacro() does."""
        self._report("WarningEvent", "DisplayWarningText", "Warning", words)

    def _report(self, event, display, kind, words):
        text = f"{kind}: {self.TITLE}: {words}"
        if self.HasObserver(event):
            self.InvokeEvent(event, text)
        else:
            getattr(vtkOutputWindow.GetInstance(), display)(text + "\n")

    def progress(self, words, fraction):
        """Shows the progress of a step. Raises Aborted where the user does not want to wait."""
        self.SetProgressText(words)
        self.UpdateProgress(fraction)
        if self.GetAbortExecute():
            raise Aborted


class ElevationPoints(TellingAlgorithm):
    """Reads the points of a file, whatever its kind; or the lines of a boundary or of faults.

    Options are those of read(), as text: empty is the default. The output is vtkPolyData with a
    vertex for each point and the point array Elevation. Its field array Recognised tells what the
    file is, which columns were taken, and what was left out; GetRecognised() gives the same text.
    """

    TITLE = "Elevation Points"
    CONTENTS = ("points", "boundary", "faults")

    def __init__(self):
        super().__init__(0, 1)
        self._file = self._columns = self._no_data = self._layer = self._classes = ""
        self._keep_nulls = self._depth = False
        self._band = self._contents = 0

    def SetFileName(self, name):
        self.change("_file", name or "")

    def GetFileName(self):
        return self._file

    def SetContents(self, contents):
        """0, 1, 2: points, a boundary, faults."""
        self.change("_contents", int(contents))

    def SetColumns(self, columns):
        """Names, or numbers from 1, of x, y and z with commas between; empty: recognised."""
        self.change("_columns", columns or "")

    def SetNoData(self, value):
        """The elevation that marks missing data, as text; empty: as the file says."""
        self.change("_no_data", "" if value is None else str(value))

    def SetKeepNulls(self, keep):
        self.change("_keep_nulls", bool(keep))

    def SetDepth(self, depth):
        self.change("_depth", bool(depth))

    def SetBand(self, number):
        """The number from 1 of a raster's band of elevations; 0: the first."""
        self.change("_band", int(number))

    def SetLayer(self, name):
        self.change("_layer", name or "")

    def SetClasses(self, numbers):
        """The classes of a LAS file to read, as "2,8"; empty: all."""
        self.change("_classes", numbers or "")

    def GetRecognised(self):
        """What was found out about the file, one line each."""
        return self._text

    def options(self):
        """The options of read(). Raises ValueError."""
        options = {"keep_nulls": self._keep_nulls, "depth": self._depth}
        if self._columns.strip():
            options["columns"] = self._columns
        if self._no_data.strip():
            try:
                options["no_data"] = float(self._no_data)
            except ValueError:
                raise ValueError(f"--no-data takes a number, not {self._no_data!r}") from None
        if self._band:
            options["band"] = self._band
        if self._layer.strip():
            options["layer"] = self._layer.strip()
        if self._classes.strip():
            options["classes"] = self._classes
        return options

    def work(self, _inputs, outputs):
        information = outputs.GetInformationObject(0)
        if information.Get(vtkStreamingDemandDrivenPipeline.UPDATE_PIECE_NUMBER()):
            return []  # one rank has it all
        if not self._file:
            raise ValueError("no file is chosen")
        output = vtkPolyData.GetData(outputs)
        if self._contents:
            lines = (None, read_boundary, read_faults)[self._contents](self._file)
            output.ShallowCopy(lines)
            count = output.GetNumberOfLines() + output.GetNumberOfPolys()
            told = [f"{self._file}: {counted(count, 'line')} of {self.CONTENTS[self._contents]}"]
        else:
            options = self.options()
            cloud = read(
                self._file,
                progress=lambda fraction: self.progress("Reading", fraction),
                **options,
            )
            fill_points(output, cloud)
            told = [f"{self._file}: {counted(output.GetNumberOfPoints(), 'point')}"]
            told += [f"{count:,} {reason} left out" for reason, count in cloud.left_out.items()]
            told += [in_panel(note) for note in cloud.notes]
            if cloud.crs:
                told.append(f"coordinate reference system: {crs_name(cloud.crs)}")
        set_words(output, "Recognised", told)
        return told


def fill_points(output, cloud):
    """The points of a Cloud with their data and a vertex for each, so that they can be seen."""
    output.SetPoints(cloud.points.GetPoints())
    output.GetPointData().ShallowCopy(cloud.points.GetPointData())
    output.GetFieldData().ShallowCopy(cloud.points.GetFieldData())
    output.SetVerts(cells_of(numpy.arange(output.GetNumberOfPoints())[:, None]))
    set_elevation(output)
    if cloud.crs:
        set_crs(output, cloud.crs)
