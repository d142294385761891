# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Drives ParaView's own client: opens menus, fills in fields and presses buttons as a user does.

A Client is a list of steps. ParaView plays them as it plays the scripts of its own tests
(--test-script), through the widgets of its window. A widget is named by the names of its parents,
joined by "/"; a name that does not exist is an error that lists those that do.
"""
import os
import signal
import subprocess
import threading
from xml.sax.saxutils import quoteattr

WINDOW = "pqClientMainWindow"
PANEL = "propertiesDock/propertiesPanel"
SHELL = "pythonShellDock/pythonShell/consoleWidget"


class Client:
    """Steps, and what is needed to play them."""

    def __init__(self, program, plugin, folder, width=1280, height=1000):
        """program: paraview, as a list with the words before it; plugin: the built plugin's file, or
        the .xml file that has it loaded by itself; folder: where the client may write."""
        self.program = program
        self.plugin = os.path.abspath(plugin)
        self.folder = os.path.abspath(folder)
        self.size = "%dx%d+0+0" % (width, height)
        self.steps = []
        os.makedirs(self.folder, exist_ok=True)

    def do(self, widget, command, arguments=""):
        """One step: a command for a widget of the main window."""
        path = "/".join(part for part in (WINDOW, widget) if part)
        self.steps.append(("pqevent", path, "command", command, str(arguments)))

    def expect(self, widget, name, value):
        """A property that a widget of the main window has to have, such as enabled, "true"."""
        self.steps.append(("pqcheck", "/".join((WINDOW, widget)), "property", name, value))

    def press(self, button):
        self.do(button, "activate")

    def choose(self, menu, entry):
        """Chooses an entry of a menu of the menu bar, such as "menuFilters/Elevation Surface"."""
        if "/" in menu:
            self.open_menu(menu.split("/")[0])  # from ParaView 5.13 on, it is filled when it is shown
        self.do("menubar/" + menu, "activate", entry)

    def open_menu(self, name):
        """Unfolds a menu of the menu bar. It stays open until the next step."""
        self.do("menubar", "activate", name)

    def open(self, path):
        """File > Open, and a file."""
        self.choose("menu_File", "actionFileOpen")
        self.do("FileOpenDialog", "filesSelected", path)

    def take_marked_reader(self):
        """Answers the question which reader to use by OK: the reader that is marked."""
        self.press("pqSelectReaderDialog/okButton")

    def set(self, name, part, value):
        """Types a value into the part of a property's widget that takes text."""
        self.do("%s/%s" % (self.field(name), part), "set_string", value)

    @staticmethod
    def field(name):
        """The widget of a property, by the property's name."""
        return PANEL + "/scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/" \
            "PropertiesFrame/ProxyPanel/" + name

    def apply(self):
        self.press(PANEL + "/Accept")

    def python(self, line):
        """Runs one line in the client's Python shell. paraview.simple knows all that is open."""
        self.do(SHELL, "executeCommand", line)

    def drag(self, start, end):
        """Drags what is at a place of the main window to another one; both are x, y in pixels."""
        for command, held, (x, y) in (("mousePress", 1, start), ("mouseMove", 1, end),
                                      ("mouseRelease", 0, end)):
            self.do("", command, "1,%d,0,%d,%d" % (held, x, y))

    def run(self, timeout):
        """Plays the steps. Returns what the client printed. RuntimeError: a step failed."""
        script = os.path.join(self.folder, "client_steps.xml")
        with open(script, "w", encoding="utf-8") as file:
            file.write('<?xml version="1.0" ?>\n<pqevents>\n')
            for element, path, what, word, arguments in self.steps:
                file.write("  <%s object=%s %s=%s arguments=%s />\n"
                           % (element, quoteattr(path), what, quoteattr(word), quoteattr(arguments)))
            file.write("</pqevents>\n")
        command = [*self.program, "-qwindowgeometry", self.size, "--dr", "--exit",
                   "--test-script=" + script]
        environment = self.environment()
        folder, name = os.path.split(self.plugin)
        if name.endswith(".xml"):
            environment["PV_PLUGIN_CONFIG_FILE"] = self.plugin
        else:
            command += ["--plugin-search-paths=" + folder, "--plugins=" + os.path.splitext(name)[0]]
        return play(command, environment, timeout)

    def environment(self):
        """No settings of the user are read, and none are written."""
        home = os.path.join(self.folder, "home")
        os.makedirs(home, mode=0o700, exist_ok=True)
        return dict(os.environ, HOME=home, XDG_CONFIG_HOME=home, XDG_RUNTIME_DIR=home,
                    XDG_CACHE_HOME=home)


def play(command, environment, timeout):
    """Runs the client. It is ended when a step fails: it would wait at an open dialog for ever."""
    process = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               start_new_session=True)

    def end():
        """Ends the client, and the programs that were started before it or by it."""
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGTERM)

    clock = threading.Timer(timeout, end)
    clock.start()
    lines = []
    for line in process.stdout:
        lines.append(line)
        if "In event 'object=" in line:
            threading.Timer(1, end).start()
    clock.cancel()
    output = "".join(lines)
    if process.wait() != 0:
        raise RuntimeError("the client ended with %d\n%s" % (process.returncode, output))
    return output
