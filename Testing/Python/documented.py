# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The code of a document in Markdown, run as it stands there: for tests, and Utilities/guide-pictures."""

import contextlib
import io
import os
import re
import shlex

import forked

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
PROGRAM = "Utilities/reconstruct"
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.M | re.S)
PICTURE = re.compile(r"!\[[^\]]*\]\(figures/guide-(\w+)\.png\)")


def text_of(name):
    """The text of Documentation/<name>."""
    with open(os.path.join(ROOT, "Documentation", name), encoding="utf-8") as file:
        return file.read()


def blocks_of(text):
    """[(language, code)] of all blocks."""
    return BLOCK.findall(text)


def examples_of(text):
    """[(language, code, [lines that it should print])] of blocks to run, and the text after each."""
    examples = []
    for language, code in blocks_of(text):
        if language == "text":
            examples[-1][2].extend(line.strip() for line in code.splitlines())
        else:
            examples.append((language, code, []))
    return examples


def make_folder(path):
    """Makes a folder to run code in: Data/ is there as in the repository."""
    os.makedirs(path, exist_ok=True)
    if not os.path.exists(os.path.join(path, "Data")):
        os.symlink(os.path.realpath(os.path.join(ROOT, "Data")), os.path.join(path, "Data"))


def run_commands(code, folder):
    """Runs lines that begin with Utilities/reconstruct, without its setting up, and returns their output."""
    printed = ""
    for line in code.replace("\\\n", " ").splitlines():
        program, *arguments = shlex.split(line)
        if program != PROGRAM:
            raise ValueError(f"not a command of {PROGRAM}: {line}")
        done = forked.python(*forked.PROGRAM, *arguments, folder=folder)
        if done.returncode != 0:
            raise RuntimeError(f"{line}\n{done.stdout}{done.stderr}")
        printed += done.stdout + done.stderr
    return printed


def run_python(code, folder, name="code", names=None):
    """Runs code in a folder, with names that it can use, and returns what it prints."""
    before = os.getcwd()
    printed = io.StringIO()
    try:
        os.chdir(folder)
        with contextlib.redirect_stdout(printed):
            exec(compile(code, name, "exec"), {} if names is None else names)
    finally:
        os.chdir(before)
    return printed.getvalue()


def run(language, code, folder):
    """What a block prints, as a list of lines without blanks at their ends."""
    do = {"sh": run_commands, "python": run_python}[language]
    return [line.strip() for line in do(code, folder).splitlines()]
