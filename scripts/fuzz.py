#!/usr/bin/env python3
"""Run `sabot check` on damaged scenes and mesh files, and see that it answers.

fuzz.py [--program build/release/sabot] [--inputs 600] [--seed 1] [--jobs N]
        [--first K] [--only scenes|meshes] [--keep DIR]

Takes scenes of prm and tests/scenes that are checked quickly, and mesh files of
every format that is read, made here. Each input is one of these with a few
mistakes: numbers that are too large, negative or no numbers, words, lines and
bytes that are gone, doubled, swapped. Every tenth valid one is also run for a
nanosecond. Input K of a seed is always the same.

Wrong are: a signal, an exit code that is none of Sabot's, no answer in time, a
report of a sanitizer, a refusal of more than a few lines, and one that names
neither the file nor an entry. Such inputs are kept, with the answer; exit code
1 where there are some.
"""
import argparse
import base64
import concurrent.futures
import os
import random
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
EXIT_CODES = range(5)
MOST_LINES, MOST_CHARACTERS = 8, 1500
NUMBERS = [b"0", b"-1", b"1", b"2", b"7", b"1e300", b"-1e300", b"1e-300", b"nan",
           b"inf", b"2000000000", b"-2147483648", b"4294967296",
           b"9223372036854775807", b"18446744073709551616", b"1e", b"0x10", b"",
           b"1 m", b"300 K", b"1e9 mm", b"0.001", b"1,2", b"text"]
PIECES = [b"\x00", b"\xff", b"\xef\xbb\xbf", b"#", b"\\\n", b"end\n", b"\n",
          b",", b"=", b"*", b"$", b"subsection x\n", b"include x.prm\n", b"\r\n",
          b"\xe4", b'"', b"<", b"%n%s"]
NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")


# Meshes: a block of 2 x 2 x 2 cells in each format.

def block():
    nodes = [(i, j, k) for k in range(3) for j in range(3) for i in range(3)]
    cells = []
    for k in range(2):
        for j in range(2):
            for i in range(2):
                n = i + 3 * j + 9 * k
                cells.append([n + d for d in (0, 1, 4, 3, 9, 10, 13, 12)])
    return nodes, cells


def abaqus():
    nodes, cells = block()
    text = "*Heading\n*Part, name=P\n*Node\n"
    for n, x in enumerate(nodes, 1):
        text += "%d, %g, %g, %g\n" % (n, *x)
    text += "*Element, type=C3D8R, elset=all\n"
    for n, cell in enumerate(cells, 1001):
        text += "%d, %s\n" % (n, ", ".join(str(a + 1) for a in cell))
    text += ("*Nset, nset=low, generate\n1, 9, 1\n*Elset, elset=up, generate\n"
             "1005, 1008, 1\n*Surface, name=top\nup, S2\n"
             "*Surface, type=NODE, name=tip\nlow, 1.\n"
             "*Solid Section, elset=all, material=m\n,\n*End Part\n"
             "*Assembly, name=A\n*Instance, name=P-1, part=P\n0., 0., 1.\n"
             "0., 0., 0., 0., 0., 1., 30.\n*End Instance\n"
             "*Instance, name=P-2, part=P\n9., 0., 0.\n*End Instance\n"
             "*Nset, nset=far, instance=P-2\nlow\n*End Assembly\n"
             "*Material, name=m\n*Elastic\n1., 0.3\n*Step\n*Element Output\nS\n"
             "*End Step\n")
    return text.encode()


def gmsh(version, binary):
    nodes, cells = block()
    out = [b"$MeshFormat\n%s %d 8\n" % (version, binary)]

    def put(form, *values):
        if binary:
            out.append(struct.pack("<" + form, *values))
        else:
            out.append((" ".join("%g" % v for v in values) + "\n").encode())

    if binary:
        put("i", 1)
    out.append(b"\n$EndMeshFormat\n$PhysicalNames\n2\n2 11 \"struck face\"\n"
               b"3 1 \"plate\"\n$EndPhysicalNames\n")
    groups = [(2, 3, 5, [c[:4] for c in cells[:4]]), (3, 5, 1, cells)]
    if version == b"2.2":
        out.append(b"$Nodes\n27\n")
        for n, x in enumerate(nodes, 1):
            put("iddd", n, *x)
        out.append(b"\n$EndNodes\n$Elements\n12\n")
        number = 0
        for dim, kind, tag, some in groups:
            if binary:
                put("iii", kind, len(some), 2)
            for c in some:
                number += 1
                tags = (11 if dim == 2 else 1, tag)
                corners = [a + 1 for a in c]
                if binary:
                    put("%di" % (3 + len(c)), number, *tags, *corners)
                else:
                    put("", number, kind, 2, *tags, *corners)
    else:
        out.append(b"$Entities\n")
        put("QQQQ", 0, 0, 1, 1)
        for dim, kind, tag, some in groups:
            put("i6dQiQ", tag, 0, 0, 0, 2, 2, 2, 1, 11 if dim == 2 else 1, 0)
        out.append(b"\n$EndEntities\n$Nodes\n")
        put("QQQQ", 1, 27, 1, 27)
        put("iiiQ", 3, 1, 0, 27)
        for n in range(1, 28):
            put("Q", n)
        for x in nodes:
            put("ddd", *x)
        out.append(b"\n$EndNodes\n$Elements\n")
        put("QQQQ", 2, 12, 1, 12)
        number = 0
        for dim, kind, tag, some in groups:
            put("iiiQ", dim, tag, kind, len(some))
            for c in some:
                number += 1
                put("%dQ" % (1 + len(c)), number, *[a + 1 for a in c])
    out.append(b"\n$EndElements\n")
    return b"".join(out)


def vtk(version, binary):
    nodes, cells = block()
    out = [b"# vtk DataFile Version %s\nblock\n%s\nDATASET UNSTRUCTURED_GRID\n"
           % (version, b"BINARY" if binary else b"ASCII")]

    def put(form, values):
        out.append(struct.pack(">%d%s" % (len(values), form), *values) if binary
                   else " ".join("%g" % v for v in values).encode())
        out.append(b"\n")

    out.append(b"POINTS 27 double\n")
    put("d", [c for x in nodes for c in x])
    if version == b"5.1":
        out.append(b"CELLS 9 64\nOFFSETS vtktypeint64\n")
        put("q", range(0, 72, 8))
        out.append(b"CONNECTIVITY vtktypeint64\n")
        put("q", [a for c in cells for a in c])
    else:
        out.append(b"CELLS 8 72\n")
        put("i", [a for c in cells for a in [8] + c])
    out.append(b"CELL_TYPES 8\n")
    put("i", [12] * 8)
    out.append(b"CELL_DATA 8\nFIELD FieldData 1\nMaterialID 1 8 int\n")
    put("i", [0] * 4 + [1] * 4)
    return b"".join(out)


def vtu(mode, packed):
    nodes, cells = block()
    arrays = [("Points", "Float64", 3, "d", [c for x in nodes for c in x]),
              ("connectivity", "Int64", 1, "q", [a for c in cells for a in c]),
              ("offsets", "Int64", 1, "q", list(range(8, 72, 8))),
              ("types", "UInt8", 1, "B", [12] * 8),
              ("MaterialID", "Int32", 1, "i", [0] * 4 + [1] * 4)]
    appended, tags = b"_", {}
    for name, kind, width, form, values in arrays:
        data = struct.pack("<%d%s" % (len(values), form), *values)
        if packed:
            inner = zlib.compress(data)
            head = struct.pack("<QQQQ", 1, len(data), 0, len(inner))
        else:
            inner, head = data, struct.pack("<Q", len(data))
        tag = b'<DataArray type="%s" Name="%s" NumberOfComponents="%d" ' % (
            kind.encode(), name.encode(), width)
        if mode == "ascii":
            body = b'format="ascii">' + " ".join(map(str, values)).encode()
        elif mode == "binary":
            body = b'format="binary">' + (
                base64.b64encode(head) + base64.b64encode(inner) if packed
                else base64.b64encode(head + inner))
        else:
            body = b'format="appended" offset="%d">' % (len(appended) - 1)
            appended += head + inner
        tags[name] = tag + body + b"</DataArray>\n"
    tail = (b'<AppendedData encoding="raw">\n' + appended + b"\n</AppendedData>\n"
            if mode == "appended" else b"")
    return (b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" '
            b'version="1.0" byte_order="LittleEndian" header_type="UInt64"%s>\n'
            b'<UnstructuredGrid>\n<Piece NumberOfPoints="27" NumberOfCells="8">\n'
            b"<CellData>\n%s</CellData>\n<Points>\n%s</Points>\n<Cells>\n"
            b"%s%s%s</Cells>\n</Piece>\n</UnstructuredGrid>\n%s</VTKFile>\n"
            % (b' compressor="vtkZLibDataCompressor"' if packed else b"",
               tags["MaterialID"], tags["Points"], tags["connectivity"],
               tags["offsets"], tags["types"], tail))


def meshes():
    made = {"abaqus.inp": abaqus()}
    for version in (b"2.2", b"4.1"):
        for binary in (0, 1):
            made["gmsh-%s-%d.msh" % (version.decode(), binary)] = gmsh(version,
                                                                      binary)
    for version in (b"3.0", b"5.1"):
        for binary in (0, 1):
            made["vtk-%s-%d.vtk" % (version.decode(), binary)] = vtk(version,
                                                                    binary)
    for mode in ("ascii", "binary", "appended"):
        for packed in (0, 1):
            if not (mode == "ascii" and packed):
                made["vtu-%s-%d.vtu" % (mode, packed)] = vtu(mode, packed)
    return made


SCENE = b"""set End time = 1 us
set List of bodies = part
subsection Materials
  subsection steel
    set Density = 7830 kg/m^3
    set Young's modulus = 206 GPa
    set Poisson's ratio = 0.3
  end
end
subsection Bodies
  subsection part
    set Geometry = file
    set Discretization = %s
    set Mesh file = %s
    set Mesh unit = 1 mm
    set Material = steel
    set Clamped faces = %s
  end
end
"""


# Mistakes.

def mutate(text, chance):
    for _ in range(chance.choice((1, 1, 1, 2, 3, 5))):
        text = MISTAKES[chance.randrange(len(MISTAKES))](text, chance)
    return text


def other_number(text, chance):
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    at = chance.choice(found)
    return text[:at.start()] + chance.choice(NUMBERS) + text[at.end():]


def other_word(text, chance):
    words = list(re.finditer(rb"\S+", text))
    if not words:
        return text
    at = chance.choice(words)
    return text[:at.start()] + chance.choice(words).group() + text[at.end():]


def lines_moved(text, chance):
    lines = text.split(b"\n")
    a, b = chance.randrange(len(lines)), chance.randrange(len(lines))
    kind = chance.randrange(4)
    if kind == 0:
        del lines[a]
    elif kind == 1:
        lines.insert(b, lines[a])
    elif kind == 2:
        lines[a], lines[b] = lines[b], lines[a]
    else:
        del lines[min(a, b):max(a, b)]
    return b"\n".join(lines)


def bytes_changed(text, chance):
    out = bytearray(text)
    for _ in range(chance.choice((1, 4, 16))):
        if out:
            out[chance.randrange(len(out))] = chance.randrange(256)
    return bytes(out)


def cut_off(text, chance):
    return text[:chance.randrange(len(text) + 1)]


def piece_put_in(text, chance):
    at = chance.randrange(len(text) + 1)
    return text[:at] + chance.choice(PIECES) + text[at:]


def number_scaled(text, chance):
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    at = chance.choice(found)
    value = float(at.group()) * chance.choice((-1, 0.5, 2, 10, 1e3, 1e-3, 1e6))
    return text[:at.start()] + (b"%g" % value) + text[at.end():]


MISTAKES = [other_number, other_number, number_scaled, other_word, lines_moved,
            lines_moved, bytes_changed, cut_off, piece_put_in]


# Runs.

class Fuzzer:
    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.folder = folder
        self.meshes = meshes()
        self.scenes = []
        self.environment = dict(
            os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
            OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", ASAN_OPTIONS="detect_leaks=0",
            UBSAN_OPTIONS="print_stacktrace=1:halt_on_error=1")
        for top in ("prm", "tests/scenes"):
            shutil.copytree(os.path.join(ROOT, top), os.path.join(folder, top))

    def limit(self):
        if not self.arguments.sanitized:
            size = self.arguments.memory << 30
            resource.setrlimit(resource.RLIMIT_AS, (size, size))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    def call(self, words, where, timeout=None):
        """Exit code (None: no answer in time) and what was said."""
        log = os.path.join(where, "answer.txt")
        with open(log, "wb") as out:
            try:
                code = subprocess.run(
                    [self.arguments.program] + words, stdout=out, cwd=where,
                    stdin=subprocess.DEVNULL, stderr=subprocess.STDOUT,
                    env=self.environment, preexec_fn=self.limit,
                    timeout=timeout or self.arguments.timeout).returncode
            except subprocess.TimeoutExpired:
                code = None
        with open(log, "rb") as out:
            return code, out.read().decode(errors="replace")

    def find_scenes(self, seconds):
        """Scenes that take so many seconds of the processor at most."""
        for top in ("prm", "tests/scenes"):
            for where, _, names in os.walk(os.path.join(self.folder, top)):
                for name in sorted(names):
                    file = os.path.join(where, name)
                    text = open(file, "rb").read()
                    if not name.endswith(".prm") or b"List of" not in text:
                        continue
                    before = resource.getrusage(resource.RUSAGE_CHILDREN)
                    code, _ = self.call(["check", file], self.folder,
                                        4. * seconds)
                    after = resource.getrusage(resource.RUSAGE_CHILDREN)
                    if (code == 0
                            and after.ru_utime - before.ru_utime < seconds):
                        self.scenes.append((file, text))
        if not self.scenes:
            sys.exit("no scene of prm and tests/scenes is valid")

    def one(self, number):
        """Kind of fault, or "" and what the answer was; and the answer."""
        chance = random.Random("%d/%d" % (self.arguments.seed, number))
        where = os.path.join(self.folder, "input-%d" % number)
        os.mkdir(where)
        only = self.arguments.only
        if only == "meshes" or (only is None and chance.random() < 0.5):
            name = chance.choice(sorted(self.meshes))
            mesh = "input" + os.path.splitext(name)[1]
            with open(os.path.join(where, mesh), "wb") as out:
                out.write(mutate(self.meshes[name], chance))
            scene = os.path.join(where, "scene.prm")
            text = SCENE % (chance.choice((b"FEM", b"FEM", b"SPG", b"rigid")),
                            mesh.encode(), chance.choice(
                                (b"", b"0", b"11", b"top", b"x = 0 mm")))
            if b"rigid" in text:
                text = re.sub(rb"    set Clamped.*\n", b"", text)
        else:
            file, original = chance.choice(self.scenes)
            text = mutate(original, chance)
            # Includes are looked up beside it.
            scene = os.path.join(os.path.dirname(file), "input-%d.prm" % number)
        with open(scene, "wb") as out:
            out.write(text)
        words = ["check", scene]
        code, answer = self.call(words, where)
        kind = self.judge(code, answer)
        if kind == "valid" and number % 10 == 0:
            words = ["run", scene, "-o", os.path.join(where, "run"), "--set",
                     "End time=1 ns"]
            code, answer = self.call(words, where)
            kind = self.judge(code, answer, True)
        if kind not in ("valid", "refused") and self.arguments.keep:
            kept = os.path.join(self.arguments.keep, "%s-%d" % (
                kind.replace(" ", "-"), number))
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(where, kept)
            if os.path.dirname(scene) != where:
                shutil.copy(scene, kept)
        if os.path.dirname(scene) != where:
            os.remove(scene)
        shutil.rmtree(where)
        return kind, " ".join(words), answer

    @staticmethod
    def judge(code, answer, is_run=False):
        if "Sanitizer" in answer or "runtime error:" in answer:
            return "sanitizer report"
        if code is None:
            return "no answer in time"
        if code < 0:
            return "signal %d" % -code
        if code not in EXIT_CODES:
            return "exit code %d" % code
        if code == 0 or (is_run and code == 2):
            return "valid"
        refusal = answer[answer.rfind("error:"):]
        if (len(refusal.strip().splitlines()) > MOST_LINES
                or len(refusal) > MOST_CHARACTERS or "---" in refusal):
            return "long answer"
        if not re.search(r"\.(prm|inp|msh|vtk|vtu)\b|[A-Z][\w' ]+/[\w' /]+",
                         refusal):
            return "nameless answer"
        return "refused"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--program",
                        default=os.path.join(ROOT, "build/release/sabot"))
    parser.add_argument("--inputs", type=int, default=600)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", choices=("scenes", "meshes"))
    parser.add_argument("--timeout", type=float, default=20.)
    parser.add_argument("--memory", type=int, default=8, help="limit in GB")
    parser.add_argument("--keep", default="fuzz-findings")
    arguments = parser.parse_args()
    arguments.program = os.path.abspath(arguments.program)
    with open(arguments.program, "rb") as program:
        arguments.sanitized = b"__asan_init" in program.read()
    counts = {}
    with tempfile.TemporaryDirectory(prefix="sabot-fuzz-") as folder:
        fuzzer = Fuzzer(arguments, folder)
        if arguments.only != "meshes":
            fuzzer.find_scenes(8. if arguments.sanitized else 0.8)
        print("%d scenes, %d meshes" % (len(fuzzer.scenes), len(fuzzer.meshes)))
        numbers = range(arguments.first, arguments.first + arguments.inputs)
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            for number, (kind, words, answer) in zip(
                    numbers, pool.map(fuzzer.one, numbers)):
                counts[kind] = counts.get(kind, 0) + 1
                if kind not in ("valid", "refused"):
                    print("input %d: %s: %s\n%s" % (number, kind, words,
                                                    answer[-1000:]), flush=True)
    print(", ".join("%s: %d" % item for item in sorted(counts.items())))
    bad = sum(n for kind, n in counts.items()
              if kind not in ("valid", "refused"))
    if bad:
        print("%d wrong of %d; kept in %s" % (bad, arguments.inputs,
                                              arguments.keep))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
