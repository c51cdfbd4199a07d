"""Signals of a candump log, by the positions that a DBC file states: no code of Glint's decoder."""
import re

FRAME = re.compile(r"BO_ (\d+) (\w+):")
SIGNAL = re.compile(r" SG_ (\w+) (?:m\d+M? |M )?: (\d+)\|(\d+)@1([+-]) \(([^,]+),([^)]+)\)")


def signals_of(dbc, message):
    """{signal: (first bit, bits, factor)} of an Intel message without sign, and its identifier."""
    signals, identifier, inside = {}, None, False
    for line in dbc.read_text().splitlines():
        if frame := FRAME.match(line):
            inside = frame[2] == message
            identifier = int(frame[1]) if inside else identifier
        elif inside and (signal := SIGNAL.match(line)):
            signals[signal[1]] = (int(signal[2]), int(signal[3]), float(signal[5]))
    return identifier, signals


def measured_ages(log, dbc):
    """(time in microseconds, age in milliseconds) of each quality frame of state `measured`."""
    identifier, signals = signals_of(dbc, "PenQuality")
    wanted = f" {identifier:03X}#"
    for line in log.read_text().splitlines():
        if wanted not in line:
            continue
        stamp, data = line[1:line.index(")")], line[line.index("#") + 1:]
        bits = int.from_bytes(bytes.fromhex(data), "little")

        def value(name):
            first, count, factor = signals[name]
            return (bits >> first & (1 << count) - 1) * factor

        if value("State") == 2:
            seconds, micro = stamp.split(".")
            yield int(seconds) * 1_000_000 + int(micro), value("Age")
