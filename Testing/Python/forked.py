# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""python3 with arguments, in processes that have imported what the program imports: that takes longer than
most surfaces of a test.

They are forked by a server, which is forked itself where this module is imported: later this process might
have threads, of which a fork has none.
"""

import atexit
import contextlib
import faulthandler
import gc
import os
import pickle
import resource
import runpy
import socket
import subprocess
import sys
import tempfile

import vtkelevationsurface.reading  # noqa: F401  (numpy and VTK, for the server too)
from vtkelevationsurface.supervisor import end_with_parent

PROGRAM = ("-m", "vtkelevationsurface")
PATIENCE = 300  # seconds


def run(arguments, folder, environment, streams, largest_file):
    """python3 with the arguments, in this process."""
    for number, name in enumerate(streams):
        os.dup2(os.open(name, os.O_WRONLY if number else os.O_RDONLY), number)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.dont_write_bytecode = bool(environment.get("PYTHONDONTWRITEBYTECODE"))
    tempfile.tempdir = None
    if largest_file:
        resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))
    if arguments[0] == "-m":
        sys.argv = arguments[1:]
        runpy.run_module(arguments[1], run_name="__main__")
    else:
        sys.argv = arguments
        sys.path.insert(0, os.path.dirname(os.path.join(folder, arguments[0])))
        runpy.run_path(arguments[0], run_name="__main__")


def run_and_end(given):
    """run() in a process that then ends as python3 would, without winding up what was there before."""
    code = 1
    try:
        end_with_parent()
        run(*given)
        code = 0
    except SystemExit as end:
        code = end.code
        if code is None or isinstance(code, int):
            code = code or 0
        else:
            print(code, file=sys.stderr)
            code = 1
    except BaseException:  # pylint: disable=broad-except
        sys.excepthook(*sys.exc_info())
    finally:
        with contextlib.suppress(OSError):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code)


def serve(requests):
    """Until nobody asks any more: runs what comes, and returns its exit code, that of subprocess."""
    with requests.makefile("rb") as stream:
        prepared = False
        while True:
            try:
                given = pickle.load(stream)
            except EOFError:
                return
            if not prepared:
                faulthandler.disable()  # python3 has none, unless it is asked to
                import vtkelevationsurface.command  # noqa: F401
                import vtkelevationsurface.picture  # noqa: F401

                gc.freeze()  # so that a fork need not copy it
                prepared = True
            child = os.fork()
            if child == 0:
                requests.close()
                run_and_end(given)
            status = os.waitpid(child, 0)[1]
            requests.sendall(pickle.dumps(os.waitstatus_to_exitcode(status)))


def start():
    """The socket of the server."""
    mine, its = socket.socketpair()
    sys.stdout.flush()
    sys.stderr.flush()
    if os.fork() == 0:
        try:
            end_with_parent()
            mine.close()
            serve(its)
        finally:
            os._exit(0)
    its.close()
    mine.settimeout(PATIENCE)
    return mine


SERVER = start()
atexit.register(SERVER.close)


def python(*arguments, folder, environment=None, largest_file=None):
    """A subprocess.CompletedProcess of python3 with the arguments: PROGRAM and its own, or a script and its
    own. The size of files can be limited, in bytes."""
    with tempfile.TemporaryDirectory() as place:
        streams = [os.devnull, os.path.join(place, "stdout"), os.path.join(place, "stderr")]
        for name in streams[1:]:
            with open(name, "wb"):
                pass
        environment = dict(os.environ if environment is None else environment)
        SERVER.sendall(pickle.dumps((list(arguments), os.path.abspath(folder), environment, streams, largest_file)))
        try:
            code = pickle.loads(SERVER.recv(1 << 10))
        except (socket.timeout, EOFError) as error:
            SERVER.close()  # so that no later call gets this one's answer
            raise AssertionError(f"{arguments}: no end in {PATIENCE} s") from error
        shown = []
        for name in streams[1:]:
            with open(name, encoding="utf-8") as stream:
                shown.append(stream.read())
    return subprocess.CompletedProcess(arguments, code, *shown)
