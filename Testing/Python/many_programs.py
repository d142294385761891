# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program again and again in the same processes, which mpirun starts once: run with a folder, where
requests appear as 0.json, 1.json and so on, and at last null. A request has a folder to run in, arguments
and, if a disk is full, [rank, what]: the size above which that rank's files cannot grow, or the function of
pieces.py or os that fails. 0.done and so on are the replies: [exit code, what was printed, errors].

Starting several processes takes longer than most surfaces of a test.
"""

import contextlib
import errno
import io
import itertools
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from unittest import mock

from vtkelevationsurface import many_processes, pieces
from vtkelevationsurface.command import main as program
from vtkelevationsurface.ranks import start_ranks


def written(path, content):
    """Makes a file that appears whole."""
    with open(path + ".new", "w", encoding="utf-8") as stream:
        json.dump(content, stream)
    os.replace(path + ".new", path)


def when_there(path, is_over=lambda: False):
    """What a file holds, once it is there. Does not use a processor while it waits, as MPI would."""
    while not os.path.exists(path):
        if is_over():
            raise RuntimeError("the processes have ended")
        time.sleep(0.005)
    with open(path, encoding="utf-8") as stream:
        return json.load(stream)


class ManyPrograms:
    """What starts the processes, and sends them requests.

    command  what starts a program on as many ranks as are wanted
    """

    def __init__(self, command):
        self.folder = tempfile.TemporaryDirectory()
        self.log = tempfile.TemporaryFile()  # pylint: disable=consider-using-with
        self.numbers = itertools.count()
        self.processes = subprocess.Popen(  # pylint: disable=consider-using-with
            [*command, sys.executable, __file__, self.folder.name],
            stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log)

    def request(self, content):
        path = os.path.join(self.folder.name, str(next(self.numbers)))
        written(path + ".json", content)
        return path + ".done"

    def run(self, folder, *arguments, full_disk=None):
        """A subprocess.CompletedProcess of the program with the arguments in the folder."""
        done = self.request([folder, arguments, full_disk])
        try:
            return subprocess.CompletedProcess(
                arguments, *when_there(done, lambda: self.processes.poll() is not None))
        except RuntimeError:
            self.log.seek(0)
            raise AssertionError(f"{arguments}: {self.log.read().decode()}") from None

    def end(self):
        """Returns mpirun's exit code."""
        self.request(None)
        code = self.processes.wait(300)
        self.log.close()
        self.folder.cleanup()
        return code


@contextlib.contextmanager
def disk_that_is_full(what):
    """Files that cannot grow above a size, or a function that fails as it would then."""
    if isinstance(what, int):
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (what, limits[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    else:
        error = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        with mock.patch.object(os if what == "mkdir" else pieces, what, side_effect=error):
            yield


def main(folder):
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    controller = start_ranks()
    rank = controller.GetLocalProcessId()
    controller.Finalize = lambda: None  # many_processes.py ends the ranks after a run
    many_processes.start_ranks = lambda: controller
    for number in itertools.count():
        path = os.path.join(folder, str(number))
        request = when_there(path + ".json")
        if request is None:
            del controller.Finalize
            controller.Finalize()
            return
        os.chdir(request[0])
        failing = disk_that_is_full(request[2][1]) if request[2] and request[2][0] == rank else \
            contextlib.nullcontext()
        shown = io.StringIO(), io.StringIO()
        with failing, contextlib.redirect_stdout(shown[0]), contextlib.redirect_stderr(shown[1]):
            code = many_processes.run_together(lambda ranks: program(request[1], ranks=ranks))
        if rank == 0:
            written(path + ".done", [code, *(stream.getvalue() for stream in shown)])


if __name__ == "__main__":
    main(sys.argv[1])
