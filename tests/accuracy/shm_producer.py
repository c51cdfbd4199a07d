"""A producer of live frames through shared memory by hand, which need not keep the rules of glint_frames.h."""
import fcntl
import os
import socket
import struct

from live_runs import WAIT_S

F_ADD_SEALS, F_SEAL_SHRINK = 1033, 2


class Producer:

    def __init__(self, path, magic=b"GLINTFR1", width=512, seal=True, bytes_part=1.0, slots=4):
        planes = 4 * 512 * 512
        self.slot_bytes = (64 + planes + 63) // 64 * 64
        self.memory = os.memfd_create("hostile", os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
        os.ftruncate(self.memory, int(bytes_part * slots * self.slot_bytes))
        if seal:
            fcntl.fcntl(self.memory, F_ADD_SEALS, F_SEAL_SHRINK)
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.settimeout(WAIT_S)
        self.socket.connect(str(path))
        hello = struct.pack("<8sIIIIQ", magic, width, 512, 16, slots, self.slot_bytes)
        reply = b""
        # Who is refused before its hello gets errors first.
        for step in (lambda: socket.send_fds(self.socket, [hello], [self.memory]),
                     lambda: self.socket.recv(256), lambda: self.socket.recv(256)):
            try:
                got = step()
            except (BrokenPipeError, ConnectionResetError):
                continue
            if isinstance(got, bytes):
                reply = got
                break
        self.refused = reply.split(b"\0")[0].decode()

    def write(self, slot, writes, planes):
        os.pwrite(self.memory, struct.pack("<Q", writes) + bytes(56) + planes,
                  slot * self.slot_bytes)

    def send(self, slot, sequence, stamp_ns, pose=None):
        self.socket.send(struct.pack("<IIQq7d", slot, pose is not None, sequence, stamp_ns,
                                     *(pose or [0.0] * 7)))

    def close(self):
        self.socket.close()
        os.close(self.memory)
