# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""A display for drawing where there is no screen: Xvfb, for as long as this program runs.

Where Xvfb does not start or answer, as on a machine that is very busy, it is started again. What
did not answer keeps its number meanwhile, so that each start has another one.
"""

import contextlib
import ctypes
import os
import select
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

from ..supervisor import STOPPING, end_with_parent

WAIT = 30.0  # seconds; a busy machine may take long
STARTS = 3  # of Xvfb, until one answers
PAUSE = 1.0  # seconds between them


class VirtualDisplay:
    """Starts Xvfb and points DISPLAY and XAUTHORITY to it.

    The server is started to end when its last client leaves, and this program stays its client. So no
    server is left behind, even if the program is killed. close() also removes the folder with the
    key that keeps other users out.
    """

    def __init__(self):
        self.servers = []
        self.folder = self.key = None
        self.reading = None  # where a server that has been started will say its number
        self.connection = None

    def open(self):
        """None, or why there is no display."""
        if not sys.platform.startswith("linux"):
            return None
        reason = why_no_server()
        if reason:
            return reason
        try:
            x11 = ctypes.CDLL("libX11.so.6")
            for start in range(STARTS):
                time.sleep(PAUSE if start else 0.0)
                if self.reading is None:
                    self.start()
                reason = self.connect(x11)
                if not reason:
                    return None
            return f"{reason}, asked {STARTS} times"
        except OSError as error:
            return f"Xvfb cannot be used: {error}"

    def start(self):
        """Starts a server, and does not wait for it. Raises OSError."""
        if self.folder is None:
            self.folder = tempfile.mkdtemp(prefix="reconstruct-display-")
            self.key = os.path.join(self.folder, "key")
            write_key(self.key)
        self.reading, writing = os.pipe()
        # A signal that stops this program waits until the server is known, so that it can be ended.
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING)

        def prepare():
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            end_with_parent()

        try:
            # A session of its own: Ctrl-C on the terminal is for this program to handle.
            server = subprocess.Popen(
                [
                    *("Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x1024x24"),
                    *("-auth", self.key, "-nolisten", "tcp", "-terminate"),
                ],
                pass_fds=(writing,),
                start_new_session=True,
                preexec_fn=prepare,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            self.servers.append(server)
        finally:
            os.close(writing)
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)

    def connect(self, x11):
        """None, or why the server that was started is none to draw on."""
        number = read_line(self.reading)
        os.close(self.reading)
        self.reading = None
        if not number:
            return "Xvfb does not start"
        os.environ["DISPLAY"] = ":" + number
        os.environ["XAUTHORITY"] = self.key
        x11.XOpenDisplay.restype = ctypes.c_void_p
        self.connection = x11.XOpenDisplay(None)
        return None if self.connection else "Xvfb does not answer"

    def close(self):
        for server in self.servers:
            server.send_signal(signal.SIGTERM)
        for server in self.servers:
            try:
                server.wait(5)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()
            # Nothing answers there any more.
            os.environ.pop("DISPLAY", None)
            os.environ.pop("XAUTHORITY", None)
        self.servers = []
        if self.reading is not None:
            os.close(self.reading)
            self.reading = None
        if self.folder is not None:
            shutil.rmtree(self.folder, ignore_errors=True)
            self.folder = None


def why_no_server():
    """Why Xvfb cannot even be tried, or None."""
    if not sys.platform.startswith("linux") or shutil.which("Xvfb"):
        return None
    return "Xvfb is not installed"


STARTED = []  # at most one VirtualDisplay, whose server is on its way


def start_screen():
    """Starts what screen() will wait for, while other work is done. cancel_screen() ends it."""
    if os.environ.get("DISPLAY") or why_no_server() or not sys.platform.startswith("linux"):
        return
    STARTED.append(VirtualDisplay())
    try:
        STARTED[-1].start()
    except OSError:
        cancel_screen()  # screen() will say why


def cancel_screen():
    while STARTED:
        STARTED.pop().close()


@contextlib.contextmanager
def screen():
    """A screen to draw on, while the context lasts; gives None, or why there is none."""
    display = STARTED.pop() if STARTED else VirtualDisplay()
    try:
        yield None if os.environ.get("DISPLAY") else display.open()
    finally:
        display.close()


def write_key(path):
    """A file as xauth writes it, with a random key for any display: family, address, number, name,
    data, each but the first with its length before it."""
    fields = (b"", b"", b"MIT-MAGIC-COOKIE-1", os.urandom(16))
    with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as stream:
        stream.write(struct.pack(">H", 65535))
        for field in fields:
            stream.write(struct.pack(">H", len(field)) + field)


def read_line(reading):
    """The number that the server prints when it is ready; "" if it ends, or not in time."""
    text = b""
    while not text.endswith(b"\n"):
        if not select.select([reading], [], [], WAIT)[0]:
            return ""
        more = os.read(reading, 64)
        if not more:
            return ""
        text += more
    return text.decode().strip()
