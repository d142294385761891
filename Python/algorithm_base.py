# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the algorithms of this package share: how they report their work, and how data sets carry
elevations."""

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkDataArray, vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkDataObject

from .clouds import coordinates_of
from .messages import Aborted, ElevationSurfaceError
from .names import PANEL, written_for
from .ranks import is_on_all_ranks, total

ELEVATION = "Elevation"
STOPPED = (
    "stopped, so the output is empty. To make it, change a property and press Apply; in scripts, "
    "call Modified()."
)


def set_elevation(data, ranks=None):
    """Adds z as the point array to colour by. Another array of this name gets another name."""
    z = numpy.ascontiguousarray(coordinates_of(data)[:, 2])
    attributes = data.GetPointData()
    old = attributes.GetAbstractArray(ELEVATION)
    differs = total(ranks, old is not None and not is_same(old, z))
    if old is not None:
        attributes.RemoveArray(ELEVATION)
        if differs:
            kept = old.NewInstance()
            kept.DeepCopy(old)
            kept.SetName(f"{ELEVATION} of the input")
            attributes.AddArray(kept)
    array = numpy_to_vtk(z, deep=True)
    array.SetName(ELEVATION)
    attributes.SetScalars(array)


def drop_elevation(points, ranks=None):
    """Takes the array Elevation away where it is nothing but z; set_elevation() makes it anew.

    ranks  the controller of those that have some of the points each, or None
    """
    array = points.GetPointData().GetAbstractArray(ELEVATION)
    differs = array is not None and not is_same(array, coordinates_of(points)[:, 2])
    if not total(ranks, differs):
        points.GetPointData().RemoveArray(ELEVATION)


def is_same(array, z):
    """Whether an array, which may be of words, holds these numbers."""
    if not isinstance(array, vtkDataArray) or array.GetNumberOfComponents() != 1:
        return False
    return numpy.array_equal(vtk_to_numpy(array), z, equal_nan=True)


def error_text(error):
    """The message for the user about an exception."""
    if isinstance(error, MemoryError):
        return "there is not enough memory"
    if isinstance(error, (ElevationSurfaceError, ValueError, TypeError)):
        return str(error)
    return f"this should not happen, please report it: {error!r}"


class ReportingAlgorithm(VTKPythonAlgorithmBase):
    """An algorithm that reports to its user what it has done or why it failed, each once."""

    def __init__(self, inputs, outputs):
        VTKPythonAlgorithmBase.__init__(
            self, nInputPorts=inputs, nOutputPorts=outputs, outputType="vtkPolyData"
        )
        self._shown = self._text = ""

    def change(self, name, value):
        """Sets an attribute, and marks the output as out of date where it differs."""
        if getattr(self, name) != value:
            setattr(self, name, value)
            self.Modified()

    def RequestData(self, request, inInfo, outInfo):
        """Runs work(inInfo, outInfo), and shows the lines that it returns, or its error.

        work() sets _text. Lines that were shown for the last output are not shown again.
        """
        self._text = ""
        self.SetAbortExecute(0)
        try:
            with written_for(PANEL):
                lines = self.work(inInfo, outInfo)
            self.UpdateProgress(1.0)
            self.check_abort()
        except Aborted:
            return self.stop(outInfo)
        except Exception as error:  # pylint: disable=broad-except
            return self.fail(error)
        text = "\n".join(lines)
        if text not in ("", self._shown):
            vtkOutputWindow.GetInstance().DisplayText(text + "\n")
        self._shown = text
        return 1

    def stop(self, outputs):
        """Empties the outputs and reports that. Returns as fail() does.

        They count as up to date: ParaView updates each of them in one Apply, which would begin anew.
        """
        for port in range(outputs.GetNumberOfInformationObjects()):
            vtkDataObject.GetData(outputs, port).Initialize()
        self._text = STOPPED
        self._shown = ""
        if self.GetAbortExecute():  # not on another rank
            vtkOutputWindow.GetInstance().DisplayText(f"{self.TITLE}: {STOPPED}\n")
        return 1

    def fail(self, error):
        """Reports an exception as vtkErrorMacro() does. Returns what RequestData() should return.

        That is success, with empty output. After a failure the executive would add meaningless lines,
        and ParaView would never update a picture of this output again.
        """
        if not is_on_all_ranks(error) or error.is_reported_here:
            self.error(error_text(error))
        self._shown = ""
        return 1

    def error(self, words):
        """Reports an error; what there is of the output stays."""
        self._report("ErrorEvent", "DisplayErrorText", "ERROR", words)

    def warn(self, words):
        """Reports a warning as vtkWarningMacro() does."""
        self._report("WarningEvent", "DisplayWarningText", "Warning", words)

    def _report(self, event, display, kind, words):
        text = f"{kind}: {words} ({self.TITLE})"  # ParaView shows the beginning alone at first
        if self.HasObserver(event):
            self.InvokeEvent(event, text)
        else:
            getattr(vtkOutputWindow.GetInstance(), display)(text + "\n")

    def progress(self, words, fraction):
        """Shows the progress of a step. Raises Aborted where the user does not want to wait."""
        self.SetProgressText(words)
        self.UpdateProgress(fraction)
        self.check_abort()

    def check_abort(self):
        if self.GetAbortExecute():
            raise Aborted
