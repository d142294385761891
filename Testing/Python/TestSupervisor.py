# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What becomes of the program's child: its code, crashes, stops, and the files that it has made."""

import os
import subprocess
import sys
import unittest

from in_folder import Program

STOPPED = "reconstruct: stopped; nothing is written\n"
SHEET = "".join(f"{i} {j} {0.5 * i - 0.25 * j:g}\n" for j in range(5) for i in range(5))
# A signal comes as the first of some files appears; the next takes longer than the parent waits.
SIGNAL_AMONG_FILES = """
def interrupted(*names, replace=os.replace, sent=[]):
    replace(*names)
    if not sent:
        sent.append(os.kill(os.getppid(), signal.{signal}))
        time.sleep(2 * supervisor.PATIENCE)
os.replace = interrupted
"""


class Supervised(Program):
    """The parent reports what happens in the child."""

    def supervise(self, body):
        script = f"import os, signal, sys, time\nfrom vtkelevationsurface import supervisor\n{body}\n"
        script += "sys.exit(supervisor.supervised(work))\n"
        return subprocess.run(
            [sys.executable, "-c", script], cwd=self.folder, text=True, capture_output=True,
            timeout=300, check=False,
        )

    def test_codes_are_handed_on(self):
        for code in (0, 1, 2, 3):
            self.assertEqual(self.supervise(f"def work(): return {code}").returncode, code)
        self.assertEqual(self.supervise("def work(): sys.exit(2)").returncode, 2)

    def test_a_crash_and_an_end_by_the_system_are_errors_that_leave_nothing(self):
        body = (
            "def work():\n"
            "    supervisor.note_partial_file('.half')\n"
            "    open('.half', 'w').close()\n"
            "    os.kill(os.getpid(), signal.{})\n"
        )
        for name, words in (("SIGSEGV", "crashed in a library (SIGSEGV)"), ("SIGKILL", "memory")):
            with self.subTest(signal=name):
                done = self.supervise(body.format(name))
                self.assertEqual(done.returncode, 1)
                # Before it, libraries may report the crash in their way.
                line = done.stderr.splitlines()[-1]
                self.assertTrue(line.startswith("reconstruct: error: the run "), done.stderr)
                self.assertIn(words, line)
                self.assertEqual(os.listdir(self.folder), [])

    def test_what_only_waits_for_the_picture_appears_after_a_crash(self):
        body = (
            "from vtkelevationsurface.results import Results\n"
            "def work():\n"
            "    results = Results()\n"
            "    results.add('a', lambda path: open(path, 'w').close())\n"
            "    results.keep_in_a_crash()\n"
            "    results.add('b', lambda path: open(path, 'w').close())\n"
            "    os.kill(os.getpid(), signal.SIGSEGV)\n"
        )
        done = self.supervise(body)
        line = done.stderr.splitlines()[-1]
        self.assertIn("crashed in a library (SIGSEGV) while it drew the picture", line)
        self.assertIn("; written before: a", line)
        self.assertEqual((done.returncode, os.listdir(self.folder)), (3, ["a"]))

    def test_a_child_that_does_not_listen_is_ended(self):
        body = (
            "def work():\n"
            "    signal.signal(signal.SIGTERM, signal.SIG_IGN)\n"
            "    os.kill(os.getppid(), signal.SIGINT)\n"
            "    time.sleep(300)\n"
            "    open('went-on', 'w').close()\n"
        )
        done = self.supervise(body)
        self.assertEqual((done.returncode, done.stderr), (130, STOPPED))
        self.assertEqual(os.listdir(self.folder), [])

    def test_files_that_appear_all_appear_whatever_is_signalled_meanwhile(self):
        self.file("a.xyz", SHEET)
        body = (
            "from vtkelevationsurface.command import main\n"
            "def work(): return main(['a.xyz', '--no-picture', '--report'])"
        )
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            with self.subTest(signal=name):
                done = self.supervise(SIGNAL_AMONG_FILES.format(signal=name) + body)
                made = sorted(set(os.listdir(self.folder)) - {"a.xyz"})
                for file in made:
                    os.remove(self.path(file))
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertEqual(made, ["a_surface.json", "a_surface.vtp"])
                self.assertIn("written", done.stdout)

    def test_each_is_stopped_between_files_and_prints_what_is_written(self):
        for name in "abc":
            self.file(f"{name}.xyz", SHEET)
        body = (
            "from vtkelevationsurface.command import main\n"
            "def work(): return main(['a.xyz', 'b.xyz', 'c.xyz', '--each', '--no-picture'])"
        )
        done = self.supervise(SIGNAL_AMONG_FILES.format(signal="SIGINT") + body)
        words = "reconstruct: stopped; written before: a_surface.vtp\n"
        self.assertEqual((done.returncode, done.stderr), (130, words))
        made = sorted(set(os.listdir(self.folder)))
        self.assertEqual(made, ["a.xyz", "a_surface.vtp", "b.xyz", "c.xyz"])

    def test_what_was_asked_before_files_appear_leaves_none(self):
        body = (
            "from vtkelevationsurface.results import Results\n"
            "def work():\n"
            "    results = Results()\n"
            "    results.add('a', lambda path: open(path, 'w').close())\n"
            "    os.kill(os.getppid(), signal.SIGTERM)\n"
            "    os.kill(os.getpid(), signal.SIGTERM)\n"
            "    results.publish()\n"
            "    return 0\n"
        )
        done = self.supervise(body)
        self.assertEqual((done.returncode, done.stderr), (130, STOPPED))
        self.assertEqual(os.listdir(self.folder), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
