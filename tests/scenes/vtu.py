"""Reads the VTU files of a run, without VTK."""
import array
import re
import struct
import zlib


def read_vtu(path):
    """Arrays of a VTU file by name, as VTK writes them here: appended, zlib.
    Arrays of vectors are lists of tuples."""
    with open(path, "rb") as file:
        head, body = file.read().split(b'<AppendedData encoding="raw">', 1)
    body = body[body.index(b"_") + 1:]
    word = "<Q" if b'header_type="UInt64"' in head else "<I"
    size = struct.calcsize(word)
    codes = {"Float64": "d", "Int64": "q", "Int32": "i", "UInt8": "B"}
    arrays = {}
    for tag in re.findall("<DataArray ([^>]*)>", head.decode()):
        entries = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        # Number of blocks, their size, size of the last, compressed sizes.
        at = int(entries["offset"])
        n = struct.unpack_from(word, body, at)[0]
        lengths = [struct.unpack_from(word, body, at + size * (3 + b))[0]
                   for b in range(n)]
        at += size * (3 + n)
        values = array.array(codes[entries["type"]])
        for length in lengths:
            values.frombytes(zlib.decompress(body[at:at + length]))
            at += length
        m = int(entries.get("NumberOfComponents", "1"))
        arrays[entries["Name"]] = list(values) if m == 1 else [
            tuple(values[i:i + m]) for i in range(0, len(values), m)]
    return arrays
