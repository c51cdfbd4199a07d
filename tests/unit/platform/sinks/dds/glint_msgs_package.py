"""Every message type of Glint's own, recorded or published, is a .msg file of the package glint_msgs.

The text of a recorded schema is that of the file, for each type in a recording of the default cell
at each level, also where one type contains another. A recorded type of another package stands in
schemas.cpp. The package lists each file and depends on the
package of each field. Every type of the DDS definitions has a file. python3-rosidl, where it is
installed, reads each file.

    glint_msgs_package.py GLINT SOURCE_FOLDER
Exit 0: all agree; 1: something differs.
"""
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

LEVELS = ("full", "roi", "blobs", "outputs")
# At the level named: what a recording without them would not test. Pictures are recorded as well:
# then a recording has each type of the live view.
EXPECTED = {"full": {"FramePatch", "HeadPose", "Choice", "Output", "Dropped", "Button", "RobotFrame",
                     "PenButtons", "PixelRectangle", "Explanation", "Regions", "Region"},
            "blobs": {"Markers", "Marker", "MarkerSigma", "MarkerTurn", "MarkerDepth"}}
SEPARATOR = "=" * 80 + "\nMSG: "
failures = []


def check(holds, text):
    if not holds:
        failures.append(text)


def schemas(data):
    """{name: text} of the schema records of an MCAP file without compression."""
    found = {}

    def strings(at, count):
        for _ in range(count):
            size = struct.unpack_from("<I", data, at)[0]
            yield data[at + 4:at + 4 + size].decode()
            at += 4 + size

    def records(at, end):
        while at + 9 <= end:
            kind, length = struct.unpack_from("<BQ", data, at)
            at += 9
            if kind == 3:
                name, encoding, text = strings(at + 2, 3)
                check(encoding == "ros2msg", f"{name}: encoding {encoding}; expected ros2msg")
                found[name] = text
            elif kind == 6:
                size = struct.unpack_from("<I", data, at + 28)[0]
                records(at + 40 + size, at + length)
            at += length

    records(8, len(data) - 8)
    return found


def types_in(schemas_of_level):
    """{"package/Type": {texts}}: the types of the schemas and those that they contain."""
    types = {}
    for name, text in schemas_of_level.items():
        own, *nested = text.split(SEPARATOR)
        types.setdefault(name.replace("/msg/", "/"), set()).add(own)
        for part in nested:
            nested_name, nested_text = part.split("\n", 1)
            types.setdefault(nested_name, set()).add(nested_text)
    return types


def check_recordings(glint, source, messages):
    default = (source / "platform/cells/default.toml").read_text()
    with tempfile.TemporaryDirectory() as folder:
        cell = pathlib.Path(folder) / "pictures.toml"
        cell.write_text(default.replace("[record]\n", "[record]\npictures = true\n", 1))
        for level in LEVELS:
            out = pathlib.Path(folder) / level
            subprocess.run([glint, "run", "--fast", "--duration", "1", "--record-level", level,
                            "--config", cell, "--out", out], check=True, stdout=subprocess.DEVNULL)
            types = types_in(schemas((out / "run.mcap").read_bytes()))
            check_others(source, types)
            own = {name.split("/")[1] for name in types if name.startswith("glint_msgs/")}
            lacking = EXPECTED.get(level, {"Output"}) - own
            check(not lacking, f"level {level}: no schema of {sorted(lacking)}")
            for name in sorted(own):
                texts = types[f"glint_msgs/{name}"]
                check(texts == {messages.get(name)},
                      f"level {level}: glint_msgs/{name} is recorded as {texts}; expected the text "
                      f"of {name}.msg: {messages.get(name)!r}")
            print(f"level {level}: {len(types)} types, {len(own)} of glint_msgs")


def check_others(source, types):
    """The types of other packages stand in schemas.cpp."""
    text = (source / "platform/sinks/record/schemas.cpp").read_text()
    stated = set(re.findall(r'Definition\{"(\w+/\w+)"', text))
    others = {name for name in types if not name.startswith("glint_msgs/")}
    check(others <= stated, f"schemas.cpp lacks {sorted(others - stated)}")


def check_package(package, messages):
    listed = re.findall(r"^  msg/(\w+)\.msg$", (package / "CMakeLists.txt").read_text(), re.M)
    check(listed == sorted(messages), f"CMakeLists.txt lists {listed}; expected {sorted(messages)}")
    root = ElementTree.parse(package / "package.xml").getroot()
    check(root.get("format") == "3" and root.findtext("name") == "glint_msgs",
          "package.xml: expected format 3 of glint_msgs")
    depends = {item.text for item in root.findall("depend")}
    used = {match for text in messages.values()
            for match in re.findall(r"^(\w+)/\w+", text, re.M)} - {"glint_msgs"}
    check(depends == used, f"package.xml depends on {depends}; the fields use {used}")
    cmake = (package / "CMakeLists.txt").read_text()
    named = set(re.search(r"DEPENDENCIES ([\w ]+)\)", cmake).group(1).split())
    check(named == used, f"CMakeLists.txt depends on {named}; the fields use {used}")


def check_parsed(package, messages):
    try:
        from rosidl_adapter.parser import parse_message_file
    except ImportError:
        print("python3-rosidl is not installed: it reads no file")
        return
    for name in messages:
        parsed = parse_message_file("glint_msgs", str(package / "msg" / f"{name}.msg"))
        lines = [line.split("#")[0].strip() for line in messages[name].splitlines()]
        expected = [line for line in lines if line]
        check(len(parsed.fields) + len(parsed.constants) == len(expected),
              f"{name}.msg: rosidl reads {parsed}; expected {expected}")
    print(f"rosidl reads {len(messages)} files")


def main():
    glint, source = sys.argv[1], pathlib.Path(sys.argv[2])
    package = source / "platform/sinks/dds/glint_msgs"
    messages = {path.stem: path.read_text() for path in (package / "msg").glob("*.msg")}
    check_recordings(glint, source, messages)
    check_package(package, messages)
    idl = (source / "platform/sinks/dds/idl/glint_msgs.idl").read_text()
    published = set(re.findall(r"struct (\w+?)_ ", idl))
    check(published and published <= set(messages),
          f"glint_msgs.idl has {published}; expected a file of each")
    check_parsed(package, messages)
    print("\n".join(failures))
    return 1 if failures else 0


sys.exit(main())
