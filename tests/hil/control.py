"""Client of the board's control port (tests/hil/run --control SOCKET), for pytest and scripts."""
import socket
import time

CONNECT_S = 60  # the board boots


class Control:
    def __init__(self, path, connect_s=CONNECT_S):
        self.socket = socket.socket(socket.AF_UNIX)
        last = time.monotonic() + connect_s
        while self.socket.connect_ex(path) != 0:
            if time.monotonic() > last:
                raise TimeoutError(f"{path}: no emulator listens; expected tests/hil/run --control")
            time.sleep(0.1)
        self.answers = self.socket.makefile("r", encoding="ascii")

    def send(self, command):
        """Returns when the board has applied the command. Raises ValueError with its reason."""
        self.socket.sendall(command.encode("ascii") + b"\n")
        answer = self.answers.readline().strip()
        if answer != "ok":
            raise ValueError(f"{command}: {answer or 'the board has ended'}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.answers.close()
        self.socket.close()
