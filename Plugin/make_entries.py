# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the server-manager XML of ParaView's entries.

    python3 Plugin/make_entries.py <template> <file to write>

The templates, ElevationSurface.xml.in and PythonEntries.xml.in, hold what is not a property; the first
explains its elements. The properties are those of Python/properties.ini.
"""
import os
import sys
import xml.etree.ElementTree as ElementTree

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from Python import first_view  # noqa: E402
from Python.description import DESCRIBED, titled  # noqa: E402

TAGS = {"double": "Double", "int": "Int", "bool": "Int", "string": "String"}
PLACES = {"ElevationPointsReader": "reader", "ReconstructElevationSurface": "chain"}


def element(parent, tag, words=None, **attributes):
    made = ElementTree.SubElement(parent, tag, attributes)
    made.text = words
    return made


def decorate(hints, name, value, inverse="0"):
    """The property is grey unless another one has this value, or has it, with inverse."""
    element(hints, "PropertyWidgetDecorator", type="GenericDecorator", mode="enabled_state",
            property=name, value=value, **({"inverse": inverse} if inverse != "0" else {}))


def add_domain(parent, one, numbers, place):
    """The values that the panel offers."""
    kind = one.kind
    if one.choices:
        domain = element(parent, "EnumerationDomain", name="enum")
        for i, choice in enumerate(one.choices):
            element(domain, "Entry", value=str(i), text=titled(choice))
    elif kind.value_type == "bool":
        element(parent, "BooleanDomain", name="bool")
    elif one.words["takes"] == "length" and place == "filter":
        # A slider that fits the data. The button that resets it gives 0, the default of the class.
        domain = element(parent, "BoundsDomain", name="range", mode="scaled_extent",
                         scale_factor=one.words.get("scale", "0.1"), default_mode="min")
        required = element(domain, "RequiredProperties")
        element(required, "Property", name="Input", function="Input")
    elif kind.value_type != "string" and len(numbers) == 1 and numbers[0] >= 0:
        domain = element(parent, TAGS[kind.value_type] + "RangeDomain", name="range", min="0")
        if kind.most < float("inf"):
            domain.set("max", f"{kind.most:g}")


def add_described(parent, one, place):
    """The element of a property. Returns its name."""
    is_text = one.kind.value_type == "string"
    numbers = [] if is_text else one.kind.numbers(one.default_in(place) or "0")
    name = one.name_in(place)
    made = element(
        parent, TAGS[one.kind.value_type] + "VectorProperty", name=name, label=one.label_in(place),
        command="Set" + name, number_of_elements=str(len(numbers) or 1),
        default_values=" ".join(str(n) if isinstance(n, int) else f"{n:g}" for n in numbers),
    )
    if place in one.words.get("advanced", "").split():
        made.set("panel_visibility", "advanced")
    add_domain(made, one, numbers, place)
    element(made, "Documentation", one.help_in(place))
    hints = ElementTree.Element("Hints")
    if "with" in one.words:
        decorate(hints, one.words["with"], "null", inverse="1")
    if "without" in one.words:
        decorate(hints, one.words["without"], "null")
    if place == "chain" and one.step == "fill" and name != "FillHoles":
        decorate(hints, "FillHoles", "1")
    if len(hints):
        made.append(hints)
    return name


def add_input(parent, given, place):
    """The element of an input."""
    made = element(parent, "InputProperty", name=given.get("name"), command="SetInputConnection",
                   port_index=given.get("port_index", "0"))
    if given.get("optional"):
        made.set("null_on_empty", "1")
        made.set("panel_widget", "input_selector")
    groups = element(made, "ProxyGroupDomain", name="groups")
    element(groups, "Group", name="sources")
    element(groups, "Group", name="filters")
    types = element(made, "DataTypeDomain", name="input_type")
    if given.get("composite_data_supported"):
        types.set("composite_data_supported", given.get("composite_data_supported"))
    for name in given.get("types").split():
        element(types, "DataType", value=name)
    described = DESCRIBED.get(given.get("property"))
    element(made, "Documentation", described.help_in(place) if described else given.text)
    if given.get("optional"):
        element(element(made, "Hints"), "Optional")


def add_result(parent, given):
    """The element of a result.

    Counts are doubles: the panel shows doubles as results, in grey, but integers as fields to fill in,
    and ids not at all. The same counts are in the field data of the output, as integers.
    """
    name, kind = given.get("name"), given.get("type", "Double")
    label = "".join(" " + letter if letter.isupper() else letter for letter in name).strip()
    made = element(parent, kind + "VectorProperty", name=name, label=label, command="Get" + name,
                   information_only="1", panel_visibility="default")
    element(made, f"Simple{kind}InformationHelper")
    if kind == "Int":
        element(made, "BooleanDomain", name="bool")
    element(made, "Documentation", given.text)
    if kind == "String":
        element(element(made, "Hints"), "Widget", type="multi_line")


def add_look(parent, given):
    """The element that has ElevationLook.cxx give a representation its first look."""
    made = element(element(parent, "Hints"), "InitializationHelper", **{
        "class": "vtkSMElevationLook", "bearing": str(first_view.BEARING), "height": str(first_view.HEIGHT)})
    if given.get("line_width"):
        made.set("line_width", given.get("line_width"))
    if given.get("of") == "elevations":
        made.set("land", " ".join(first_view.LAND))
        made.set("sea", " ".join(first_view.SEA))
    elif given.get("of") == "holes":
        made.set("array", "StatusName")
        made.set("words", ",".join(first_view.STATUS))
        made.set("colours", " ".join(first_view.STATUS.values()))


def add(parent, given, place):
    """Adds what an element of the template becomes. Returns the names of its properties."""
    names = [given.get("name")]
    if given.tag == "Described":
        names = [add_described(parent, DESCRIBED[one], place) for one in given.get("names").split()]
    elif given.tag == "Input":
        add_input(parent, given, place)
    elif given.tag == "Result":
        add_result(parent, given)
    elif given.tag == "Look":
        add_look(parent, given)
    elif given.tag == "Group":
        names = [name for one in given for name in add(parent, one, place)]
        group = element(parent, "PropertyGroup", label=given.get("label"))
        for name in names:
            element(group, "Property", name=name)
    else:
        parent.append(given)
    return names


def main(template, path):
    tree = ElementTree.parse(template)
    for proxy in (proxy for group in tree.getroot() for proxy in group):
        parts = list(proxy)
        for part in parts:
            proxy.remove(part)
        for part in parts:
            add(proxy, part, PLACES.get(proxy.get("name"), "filter"))
    ElementTree.indent(tree)
    tree.write(path, encoding="utf-8", xml_declaration=True)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
