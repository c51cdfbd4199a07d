"""Each topic in the Foxglove layout and in the RViz configuration is one of a run, with that type.

    check_layouts.py GLINT SOURCE_FOLDER
Exit 0: all are; 1: one is not.
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

import yaml

RVIZ_TYPES = {
    "MarkerArray": "visualization_msgs/msg/MarkerArray",
    "PoseWithCovariance": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "Image": "sensor_msgs/msg/Image",
    "RobotModel": "std_msgs/msg/String",
}
# What Foxglove's 3D panel draws.
DRAWN_TYPES = {"visualization_msgs/msg/MarkerArray", "geometry_msgs/msg/PoseStamped",
               "geometry_msgs/msg/PoseWithCovarianceStamped"}
failures = []


def check(holds, text):
    if not holds:
        failures.append(text)


def topics_of(path):
    """{topic: (type, schema)} of an MCAP file."""
    data, schemas, topics = path.read_bytes(), {}, {}

    def text(at):
        size = struct.unpack_from("<I", data, at)[0]
        return data[at + 4:at + 4 + size].decode(), at + 4 + size

    def records(at, end):
        while at + 9 <= end:
            kind, length = struct.unpack_from("<BQ", data, at)
            at += 9
            if kind == 3:
                name, after = text(at + 2)
                schemas[struct.unpack_from("<H", data, at)[0]] = (name, text(text(after)[1])[0])
            elif kind == 4:
                topics[text(at + 4)[0]] = schemas[struct.unpack_from("<H", data, at + 2)[0]]
            elif kind == 6:
                size = struct.unpack_from("<I", data, at + 28)[0]
                records(at + 40 + size, at + length)
            at += length

    records(8, len(data) - 8)
    return topics


def has_field(schema, field):
    own = schema.split("=" * 80)[0]
    return any(line.split("#")[0].split()[1:2] == [field] for line in own.splitlines())


def check_foxglove(path, topics):
    layout = json.loads(path.read_text())
    named = 0

    def expect(topic, types, place):
        nonlocal named
        named += 1
        check(topic in topics, f"{place}: no topic {topic}; expected one of {sorted(topics)}")
        if topic in topics and types:
            check(topics[topic][0] in types, f"{place}: {topic} is {topics[topic][0]}; expected one of "
                  f"{sorted(types)}")

    shown = set()

    def collect(node):
        if isinstance(node, str):
            shown.add(node)
        else:
            collect(node["first"])
            collect(node["second"])

    collect(layout["layout"])
    check(shown == set(layout["configById"]), f"{path.name}: shows {shown}; expected the panels "
          f"{set(layout['configById'])}")
    for panel, config in layout["configById"].items():
        for topic in config.get("topics", {}):
            expect(topic, DRAWN_TYPES, panel)
        for layer in config.get("layers", {}).values():
            expect(layer["topic"], {"std_msgs/msg/String"}, panel)
        if "imageMode" in config:
            expect(config["imageMode"]["imageTopic"], {"sensor_msgs/msg/Image"}, panel)
            expect(config["imageMode"]["calibrationTopic"], {"sensor_msgs/msg/CameraInfo"}, panel)
        if "topicPath" in config:
            expect(config["topicPath"], None, panel)
        for line in config.get("paths", []):
            topic, field = line["value"].rsplit(".", 1)
            expect(topic, None, panel)
            check(topic in topics and has_field(topics[topic][1], field),
                  f"{panel}: {topic} has no field {field}")
    return named


def check_rviz(path, topics):
    named = 0
    for display in yaml.safe_load(path.read_text())["Visualization Manager"]["Displays"]:
        kind = display["Class"].split("/")[-1]
        topic = (display.get("Topic") or display.get("Description Topic") or {}).get("Value")
        if topic is None:
            check(kind in ("Grid", "TF"), f"{path.name}: {kind} has no topic")
            continue
        named += 1
        found = topics.get(topic, ("no topic",))[0]
        check(found == RVIZ_TYPES[kind], f"{path.name}: {topic} is {found}; expected {RVIZ_TYPES[kind]}")
    return named


def main():
    glint, source = sys.argv[1], pathlib.Path(sys.argv[2])
    view = source / "platform/sinks/view"
    cell_text = (source / "platform/cells/default.toml").read_text()
    urdf = source / "platform/doc/samples/arm.urdf"
    with tempfile.TemporaryDirectory() as folder:
        cell = pathlib.Path(folder) / "cell.toml"
        cell.write_text(cell_text.replace("[record]\n", "[record]\npictures = true\n", 1)
                        .replace("[robot]\n", f'[robot]\nurdf = "{urdf}"\n', 1))
        subprocess.run([glint, "run", "--fast", "--duration", "1", "--config", cell, "--out", folder],
                       check=True, stdout=subprocess.DEVNULL)
        topics = topics_of(pathlib.Path(folder) / "run.mcap")
    counts = (check_foxglove(view / "glint.foxglove.json", topics),
              check_rviz(view / "glint.rviz", topics))
    print(f"{counts[0]} topics in the Foxglove layout, {counts[1]} in the RViz configuration")
    check(min(counts) >= 4, "expected at least 4 in each")
    print("\n".join(failures))
    return 1 if failures else 0


sys.exit(main())
