"""End of an MCAP file that was not closed, by the layout of mcap.dev/spec: no code of Glint's reader."""
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
CHUNK = 0x06


def end_of_last_chunk(file):
    """Time of the last message of the last complete chunk, ns; its checksum must hold. 0: none."""
    data = file.read_bytes()
    if not data.startswith(MAGIC):
        return 0
    at, end = len(MAGIC), 0
    while at + 9 <= len(data):
        kind, length = struct.unpack_from("<BQ", data, at)
        record = data[at + 9:at + 9 + length]
        if kind == 0 or len(record) < length:
            break
        if kind == CHUNK:
            _, last, _, checksum, name = struct.unpack_from("<QQQII", record)
            records = record[32 + name + 8:]
            if name == 0 and checksum != 0 and zlib.crc32(records) != checksum:
                break
            end = last
        at += 9 + length
    return end
