# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program in a process of its own, so that it can be stopped, or crash, cleanly.

Libraries in C++ do not hear of Ctrl-C until they are done. So the program works in a child. The
parent waits for it, asks it to stop, ends it if it does not, and removes what it has left behind:
unfinished results and the folder of its temporary files. While finished results appear, the child
is not stopped. Nothing here is imported that takes time.

They communicate by SIGTERM from the parent, and by files in a folder: the names of unfinished results, the
names of those that are complete but wait for the picture, the names of those that have appeared, and a
file that is there while stops are held back.
"""

import ctypes
import os
import shutil
import signal
import sys
import tempfile
import time

PATIENCE = 0.5  # seconds from the request to stop to the end by force
STOPPING = [
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
]
STOPPED = "reconstruct: stopped"
NOTHING = "nothing is written"
MOST_NAMED = 10
RUN = "ELEVATION_SURFACE_RUN"  # the environment variable that names the folder for the child
PARTIAL_FILES, FINISHED_FILES, HELD = "partial-files", "finished-files", "held"
WHOLE_FILES = "whole-files"
# What Open MPI, and MPICH and its relatives, set for a process that mpirun has started.
RANKS = (("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"), ("PMI_RANK", "PMI_SIZE"))
held_back = []  # stops that were asked for since hold_stops()
listening = []  # what answered to stops before
PR_SET_PDEATHSIG = 1  # <sys/prctl.h>


def rank_and_size():
    """(number, count) of this process among those that mpirun has started; (0, 1): it is alone."""
    for rank, size in RANKS:
        if rank in os.environ and size in os.environ:
            return int(os.environ[rank]), int(os.environ[size])
    return 0, 1


def end_with_parent():
    """Asks Linux to end this process when its parent does."""
    if sys.platform.startswith("linux"):
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, int(signal.SIGTERM))


def note_partial_file(path):
    """Reports a file or folder that is not finished to the parent, which removes it if this process
    cannot."""
    note(PARTIAL_FILES, os.path.abspath(path))


def note_whole_file(partial, path):
    """Reports a result that only waits for the picture, and its final place, to the parent."""
    note(WHOLE_FILES, os.path.abspath(partial))
    note(WHOLE_FILES, path)


def note_finished_file(path):
    """Reports a result that has appeared to the parent."""
    note(FINISHED_FILES, path)


def note(name, words):
    folder = os.environ.get(RUN)
    if folder:
        with open(os.path.join(folder, name), "a", encoding="utf-8") as stream:
            stream.write(words + "\0")


def noted(folder, name):
    """What note() has written, in its order."""
    try:
        with open(os.path.join(folder, name), encoding="utf-8") as stream:
            return stream.read().split("\0")[:-1]
    except OSError:
        return []


def hold_stops():
    """Lets nothing stop this process from now on: its results appear, and its code will count.

    Raises KeyboardInterrupt where it has been asked to stop before.
    """
    folder = os.environ.get(RUN)
    if folder:
        # The parent asks, waits, looks for this file, and only then ends this process by force. So
        # where the file comes too late, what was asked is heard in the next line.
        note(HELD, "")
        listening.append(signal.signal(signal.SIGTERM, lambda *_: held_back.append(True)))


def allow_stops():
    """The end of hold_stops(). Raises KeyboardInterrupt where a stop was asked for meanwhile."""
    folder = os.environ.get(RUN)
    if folder and is_held(folder):
        signal.signal(signal.SIGTERM, listening[0])
        os.remove(os.path.join(folder, HELD))
        if held_back:
            stop()


def is_held(folder):
    return os.path.exists(os.path.join(folder, HELD))


def stop(*_):
    """Interrupts this process without any output: what else it would print does not matter."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    raise KeyboardInterrupt


def keep_whole_files(folder):
    """Lets the results appear that only waited for the picture. Returns whether there were some."""
    names = noted(folder, WHOLE_FILES)
    waiting = [pair for pair in zip(names[::2], names[1::2]) if os.path.exists(pair[0])]
    for partial, path in waiting:
        os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
        os.replace(partial, path)
        with open(os.path.join(folder, FINISHED_FILES), "a", encoding="utf-8") as stream:
            stream.write(path + "\0")
    return bool(waiting)


def remove_folder(path):
    """Removes a folder in which other processes may still make files: they do not find it any more."""
    gone = path + ".gone"
    try:
        os.rename(path, gone)
    except OSError:
        gone = path
    shutil.rmtree(gone, ignore_errors=True)


def remove_leftovers(folder):
    for path in noted(folder, PARTIAL_FILES):
        if os.path.isdir(path):
            remove_folder(path)
        elif os.path.isfile(path):
            os.remove(path)
    shutil.rmtree(folder, ignore_errors=True)


def what_is_written(folder):
    """The results that have appeared, for messages."""
    names = noted(folder, FINISHED_FILES)
    if not names:
        return NOTHING
    more = f" and {len(names) - MOST_NAMED:,} more" if len(names) > MOST_NAMED else ""
    return f"written before: {', '.join(names[:MOST_NAMED])}{more}"


def supervised(work):
    """Calls work() in a child process. Returns the exit code: work's, 130 if stopped, 1 after a
    crash, 3 where only the picture was missing then.

    Of several processes that mpirun has started, the first alone is stopped so; others write files in
    a folder of its own alone. They have to outlive it: when one is gone, mpirun ends all by force.
    """
    rank, size = rank_and_size()
    if rank > 0:
        for number in STOPPING:
            signal.signal(number, signal.SIG_IGN)
        return work()
    if not hasattr(os, "fork"):
        try:
            return work()
        except KeyboardInterrupt:
            print(STOPPED, file=sys.stderr)
            return 130
    stops = []
    for number in STOPPING:
        signal.signal(number, lambda *_: stops.append(True))
    folder = tempfile.mkdtemp(prefix="reconstruct-")
    child = os.fork()
    if child == 0:
        be_child(work, folder)
    status = wait_for(child, stops, folder, is_alone=size == 1)
    if status is None:
        return 130
    for number in STOPPING:
        signal.signal(number, signal.SIG_IGN)  # too late; Python's own end would reset handlers
    code = os.WEXITSTATUS(status) if os.WIFEXITED(status) else None
    has_crashed = code is None and not stops
    crashed_drawing = has_crashed and keep_whole_files(folder)
    is_done, written = is_held(folder), what_is_written(folder)
    remove_leftovers(folder)
    if code == 0 or code in (1, 2, 3) and (is_done or not stops):
        return code
    if sys.stderr.isatty():
        sys.stderr.write("\r" + " " * 60 + "\r")
    if stops:
        print(f"{STOPPED}; {written}", file=sys.stderr)
        return 130
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGKILL:
        reason = "was ended by the system, most likely for want of memory"
    elif os.WIFSIGNALED(status):
        reason = f"crashed in a library ({signal.Signals(os.WTERMSIG(status)).name})"
    else:
        reason = f"ended with code {code}"
    if crashed_drawing:
        reason += " while it drew the picture"
    print(f"reconstruct: error: the run {reason}; {written}", file=sys.stderr)
    return 3 if crashed_drawing else 1


def be_child(work, folder):
    """Does not return. Ctrl-C is for the parent, who then sends SIGTERM."""
    code = 1
    try:
        for number in STOPPING:
            signal.signal(number, signal.SIG_IGN)
        if rank_and_size()[1] == 1:
            signal.signal(signal.SIGTERM, stop)
        end_with_parent()
        os.environ[RUN] = folder
        tempfile.tempdir = folder
        code = work()
    except KeyboardInterrupt:
        code = 130
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:  # pylint: disable=broad-except
        sys.excepthook(*sys.exc_info())
    finally:
        # Libraries are not wound up: a window whose display has gone would complain.
        try:
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(code or 0)


def end_first(child, folder, must_end=False):
    """Ends the child of the first of several processes, unless its results appear. Returns whether.

    As soon as it is gone, mpirun ends this process too. So everything is removed and reported before.
    """
    os.kill(child, signal.SIGSTOP)
    if is_held(folder) and not must_end:
        os.kill(child, signal.SIGCONT)
        return False
    written = what_is_written(folder)
    remove_leftovers(folder)
    print(f"{STOPPED}; {written}", file=sys.stderr, flush=True)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return True


def wait_for(child, stops, folder, is_alone):
    """The child's status. A child that does not stop when asked is ended by force, but not while
    its results appear. None: all is done, as by end_first()."""
    asked = None
    while True:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return status
        if stops and asked is None:
            asked = time.monotonic()
            if is_alone:
                os.kill(child, signal.SIGTERM)
            elif end_first(child, folder):
                return None
        elif asked is None or time.monotonic() - asked <= PATIENCE:
            pass
        elif not is_alone:
            end_first(child, folder, must_end=True)  # it cannot say goodbye to processes that are gone
            return None
        elif not is_held(folder):
            os.kill(child, signal.SIGKILL)
            return os.waitpid(child, 0)[1]
        time.sleep(0.01)
