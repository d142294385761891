# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The messages in Documentation/ParaView.md, for tests that get the real ones."""
import os
import re

GUIDE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../Documentation/ParaView.md")


def guide_text():
    with open(GUIDE, encoding="utf-8") as file:
        return file.read()


def guide_messages(section):
    """{heading: message} of a section: the first block of text after each heading, or its own."""
    heading = "## %s\n" % section
    text = guide_text().split("\n" + heading)[1].split("\n## ")[0]
    block = r"^#+ (.+)\n(?:(?!#+ ).*\n)*?```text\n((?:(?!```).*\n)*)"
    return dict(re.findall(block, heading + text, re.M))


def is_message(message, expected):
    """Whether a message is what the guide shows, where "…" stands for anything.

    Of the message counts what Output Messages shows: not its kind, class and address.
    """
    place = r"^\s*((ERROR|Warning): )?(In \S+, line \d+\n)?(\w+ \(0x[0-9a-f]+\): )?"
    words = r"\s+".join(re.escape(word) for word in expected.split()).replace("…", ".*?")
    return re.fullmatch(words, re.sub(place, "", message).strip(), re.DOTALL) is not None
