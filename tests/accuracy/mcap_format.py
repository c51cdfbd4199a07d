"""ROS 2 messages in CDR, bags in MCAP without compression, and the frames of Glint's recordings:
written and read without Glint and without a package.
"""
import array
import struct
import zlib

import frame_formats as formats


class Cdr:
    def __init__(self):
        self.bytes = bytearray(b"\0\1\0\0")

    def put(self, kind, *values):
        size = struct.calcsize(kind)
        for value in values:
            self.bytes += b"\0" * (-(len(self.bytes) - 4) % size) + struct.pack("<" + kind, value)
        return self

    def text(self, text):
        self.put("I", len(text) + 1)
        self.bytes += text.encode() + b"\0"
        return self

    def raw(self, data):
        self.put("I", len(data))
        self.bytes += data
        return self

    def header(self, stamp_ns, frame):
        return self.put("i", stamp_ns // 10**9).put("I", stamp_ns % 10**9).text(frame)


def image(stamp_ns, frame, width, height, encoding, data):
    step = len(data) // height
    return bytes(Cdr().header(stamp_ns, frame).put("I", height, width).text(encoding)
                 .put("B", 0).put("I", step).raw(data).bytes)


def transforms(items):
    """(stamp, parent, child, (rotation, position)) each."""
    cdr = Cdr().put("I", len(items))
    for stamp_ns, parent, child, (rotation, position) in items:
        cdr.header(stamp_ns, parent).text(child).put("d", *position)
        cdr.put("d", *formats.quaternion_of(rotation))
    return bytes(cdr.bytes)


def pose_stamped(stamp_ns, frame, position, q):
    return bytes(Cdr().header(stamp_ns, frame).put("d", *position, *q).bytes)


class Mcap:
    """A file of one chunk each `chunk_messages` messages, with index and checksums."""

    def __init__(self, path, chunk_messages=16):
        self.file = open(path, "wb")
        self.file.write(b"\x89MCAP0\r\n")
        self._record(1, self._text("ros2") + self._text("by hand"))
        self.channels, self.counts, self.times = {}, {}, []
        self.chunk, self.messages, self.chunk_messages = bytearray(), 0, chunk_messages
        self.index = []

    @staticmethod
    def _text(text):
        return struct.pack("<I", len(text)) + text.encode()

    @staticmethod
    def _bytes(kind, content):
        return struct.pack("<BQ", kind, len(content)) + content

    def _record(self, kind, content):
        self.file.write(self._bytes(kind, content))

    def _declare(self, topic, schema):
        number = len(self.channels) + 1
        self.channels[topic] = (number,
                                self._bytes(3, struct.pack("<H", number) + self._text(schema) +
                                            self._text("ros2msg") + struct.pack("<I", 0)) +
                                self._bytes(4, struct.pack("<HH", number, number) +
                                            self._text(topic) + self._text("cdr") +
                                            struct.pack("<I", 0)))
        self.chunk += self.channels[topic][1]

    def write(self, topic, schema, log_ns, payload):
        if topic not in self.channels:
            self._declare(topic, schema)
        number = self.channels[topic][0]
        self.counts[number] = self.counts.get(number, 0) + 1
        self.chunk += self._bytes(5, struct.pack("<HIQQ", number, self.messages & 0xFFFFFFFF,
                                                 log_ns, log_ns) + payload)
        self.times.append(log_ns)
        self.messages += 1
        if self.messages % self.chunk_messages == 0:
            self._close_chunk()

    def _close_chunk(self):
        if not self.chunk:
            return
        start, end = (min(self.times), max(self.times)) if self.times else (0, 0)
        at = self.file.tell()
        content = (struct.pack("<QQQI", start, end, len(self.chunk), zlib.crc32(self.chunk)) +
                   self._text("") + struct.pack("<Q", len(self.chunk)) + bytes(self.chunk))
        self._record(6, content)
        self.index.append((start, end, at, self.file.tell() - at, len(self.chunk)))
        self.chunk, self.times = bytearray(), []

    def close(self):
        self._close_chunk()
        self._record(15, struct.pack("<I", 0))
        start = self.file.tell()
        for _, declaration in self.channels.values():
            self.file.write(declaration)
        for first, last, at, length, size in self.index:
            self._record(8, struct.pack("<QQQQIQ", first, last, at, length, 0, 0) + self._text("") +
                         struct.pack("<QQ", size, size))
        counts = b"".join(struct.pack("<HQ", *item) for item in self.counts.items())
        self._record(11, struct.pack("<QHIIIIQQ", self.messages, len(self.channels),
                                     len(self.channels), 0, 0, len(self.index), 0, 0) +
                     struct.pack("<I", len(counts)) + counts)
        self._record(2, struct.pack("<QQI", start, 0, 0))
        self.file.write(b"\x89MCAP0\r\n")
        self.file.close()


def write_bag(path, width, height, frames):
    """Head pose by tf: world <- rig moves, rig <- camera is static."""
    bag = Mcap(path)
    first = frames[0].stamp_ns
    bag.write("/tf_static", "tf2_msgs/msg/TFMessage", first,
              transforms([(0, "rig", "tof_optical", formats.RIG)]))
    for f in frames:
        if f.pose:
            bag.write("/tf", "tf2_msgs/msg/TFMessage", f.stamp_ns,
                      transforms([(f.stamp_ns, "world", "rig", formats.rig_pose(f.pose))]))
        for topic, encoding, values in (("/tof/depth", "16UC1", f.depth),
                                        ("/tof/reflectivity", "mono16", f.bright)):
            bag.write(topic, "sensor_msgs/msg/Image", f.arrives_ns(),
                      image(f.stamp_ns, "tof_optical", width, height, encoding, values.tobytes()))
    bag.close()
    return path


class Bytes:
    """Reads a message field by field."""

    def __init__(self, data):
        self.data, self.at = data, 4

    def get(self, kind, count=1):
        size = struct.calcsize(kind)
        self.at += -(self.at - 4) % size
        values = struct.unpack_from("<%d%s" % (count, kind), self.data, self.at)
        self.at += size * count
        return values if count > 1 else values[0]

    def take(self):
        count = self.get("I")
        self.at += count
        return self.data[self.at - count:self.at]

    def header(self):
        return self.get("i") * 10**9 + self.get("I"), self.take()


def messages_of(data):
    """(topic, CDR) of each message of a file without compression, in its order."""
    names = {}

    def records(start, end):
        at = start
        while at + 9 <= end:
            kind, length = struct.unpack_from("<BQ", data, at)
            at += 9
            if kind == 4:
                number, size = struct.unpack_from("<H", data, at)[0], struct.unpack_from(
                    "<I", data, at + 4)[0]
                names[number] = data[at + 8:at + 8 + size].decode()
            elif kind == 5:
                number = struct.unpack_from("<H", data, at)[0]
                yield names[number], data[at + 22:at + length]
            elif kind == 6:
                size = struct.unpack_from("<I", data, at + 28)[0]
                assert size == 0, "compressed"
                yield from records(at + 40, at + length)
            elif kind == 15:
                return
            at += length

    yield from records(8, len(data))


def read_recording(path):
    """(width, height, frames) of a recording of Glint at level full."""
    data = path.read_bytes()
    planes, frames, head = {}, [], {}
    width = height = 0

    def message(topic, payload):
        nonlocal width, height
        cdr = Bytes(payload)
        if topic in ("/glint/reflectivity", "/glint/depth"):
            cdr.header()
            height, width = cdr.get("I"), cdr.get("I")
            cdr.take(), cdr.get("B"), cdr.get("I")
            planes[topic] = array.array("H", cdr.take())
        elif topic == "/glint/head_pose":
            cdr.header()
            time, valid = cdr.get("q"), cdr.get("B")
            numbers = cdr.get("d", 7)
            head[time] = (numbers[:3], numbers[3:]) if valid else None
        elif topic == "/glint/frame":
            cdr.header()
            stamp, arrival, sequence = cdr.get("q"), cdr.get("q"), cdr.get("I")
            frames.append(formats.Frame(stamp, planes["/glint/reflectivity"],
                                        planes["/glint/depth"], head.get(stamp), sequence, arrival))

    for topic, payload in messages_of(data):
        message(topic, payload)
    return width, height, frames
