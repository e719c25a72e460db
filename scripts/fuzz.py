#!/usr/bin/env python3
"""Run `sabot check` on damaged scenes and mesh files, and see that it answers.

fuzz.py [--program build/release/sabot] [--inputs 2000] [--seed 1] [--jobs N]
        [--first K] [--only scenes|meshes] [--batch 50] [--runs 0.1] [--keep DIR]

Takes scenes of prm and tests/scenes that are checked quickly, and mesh files of
every format that is read, made here. Each input is one of these with a few
mistakes: numbers that are too large, negative or no numbers, words, lines and
bytes that are gone, doubled, swapped; in scenes also entries of any value that
they may have. One process checks a batch of them, since starting takes longer
than checking; what it answers wrongly is checked again alone. A part of the
valid ones is also run for a nanosecond. Input K of a seed is always the same.

Wrong are: a signal, an exit code that is none of Sabot's, no answer in time of
a scene that is not said to be large, a report of a sanitizer, a refusal of more
than a few lines, and one that names neither the file nor an entry. Such inputs
are kept, with the answer; exit code 1 where there are some.
"""
import argparse
import concurrent.futures
import json
import os
import random
import re
import resource
import select
import shutil
import subprocess
import sys
import tempfile
import time

from fuzz_inputs import SCENE, meshes, mutate

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
EXIT_CODES = range(6)
MOST_LINES, MOST_CHARACTERS = 8, 1500
MOST_ITEMS = 10000  # cells and particles of a scene
LARGE = "note: making "
RIGHT = ("valid", "refused", "large")


def seconds_used(pid):
    """Of the processor, by a process that has not been waited for."""
    with open("/proc/%d/stat" % pid, "rb") as file:
        fields = file.read().rpartition(b")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Fuzzer:
    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.folder = folder
        self.meshes = meshes()
        self.scenes = []
        self.declared = None  # entries of scenes
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

    def begin(self, words, where):
        return subprocess.Popen(
            [self.arguments.program] + words, cwd=where, env=self.environment,
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, preexec_fn=self.limit)

    def listen(self, process, timeout):
        """What it says, and its exit code; None where it took longer than so
        many seconds of the processor, or ten times as many of a busy machine,
        without a word."""
        said = bytearray()
        used, began = 0., time.monotonic()
        while True:
            ready, _, _ = select.select([process.stdout], [], [], 0.5)
            if ready:
                piece = os.read(process.stdout.fileno(), 65536)
                if not piece:
                    break
                said += piece
                used, began = seconds_used(process.pid), time.monotonic()
            elif (seconds_used(process.pid) - used > timeout
                  or time.monotonic() - began > 10. * timeout):
                process.kill()
                process.communicate()
                return None, said.decode(errors="replace")
        process.stdout.close()
        return process.wait(), said.decode(errors="replace")

    def call(self, words, where, timeout=None):
        return self.listen(self.begin(words, where),
                           timeout or self.arguments.timeout)

    def find_scenes(self):
        """Valid scenes that are not large, always in the same order."""
        files = []
        for top in ("prm", "tests/scenes"):
            for where, _, names in os.walk(os.path.join(self.folder, top)):
                files += [os.path.join(where, name) for name in names
                          if name.endswith(".prm")]
        for file in sorted(files):
            with open(file, "rb") as stream:
                text = stream.read()
            if b"List of" not in text and b"include" not in text:
                continue
            # Large ones take longer.
            _, answer = self.call(["check", file], self.folder, 15.)
            items = [int(n) for n in re.findall(r"\((\d+) [a-z]+\)",
                                                answer.rpartition("valid:")[2])]
            if "is valid:" in answer and sum(items) < MOST_ITEMS:
                self.scenes.append((file, text))
        self.declared = json.loads(subprocess.run(
            [self.arguments.program, "parameters", "--format", "json"],
            stdout=subprocess.PIPE, env=self.environment, check=True).stdout)
        if not self.scenes:
            sys.exit("no scene of prm and tests/scenes is valid")

    def make(self, number):
        """Write input @p number: its folder and its scene."""
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
            text = mutate(original, chance, self.declared)
            # Includes are looked up beside it.
            scene = os.path.join(os.path.dirname(file), "input-%d.prm" % number)
        with open(scene, "wb") as out:
            out.write(text)
        return where, scene, chance.random() < self.arguments.runs

    def check_together(self, scenes):
        """What one process says of each scene until it ends or takes too long,
        and its exit code, None for the latter."""
        code, text = self.call(["check"] + scenes, self.folder)
        at = [text.find("checking %s\n" % scene) for scene in scenes]
        at = at[:at.index(-1)] if -1 in at else at
        return [text[a + len("checking \n") + len(scene):b] for a, b, scene
                in zip(at, at[1:] + [len(text)], scenes)], code

    def batch(self, numbers):
        """Kind, command and answer of each input: kind of fault, or "valid" or
        "refused"."""
        inputs = [self.make(number) for number in numbers]
        results = []
        while len(results) < len(inputs):
            rest = inputs[len(results):]
            answers, code = self.check_together([scene for _, scene, _ in rest])
            if not answers:
                sys.exit("no answer to: check %s" % rest[0][1])
            for (where, scene, is_run), answer in zip(rest, answers):
                kind = self.judge(0 if "is valid:" in answer else 1, answer)
                command = ["check", scene]
                is_last = len(results) + 1 == len(inputs) - len(rest) + len(
                    answers)
                if (kind not in RIGHT
                        or (is_last and code not in (0, 1))
                        or (kind == "refused" and code not in (None, 1)
                            and code > 1)):
                    alone, answer = self.call(command, where)
                    kind = self.judge(alone, answer)
                if kind == "valid" and is_run:
                    command = ["run", scene, "-o", os.path.join(where, "run"),
                               "--set", "End time=1 ns"]
                    alone, answer = self.call(command, where)
                    kind = self.judge(alone, answer, True)
                results.append((kind, " ".join(command), answer))
        for number, (where, scene, _), (kind, _, _) in zip(numbers, inputs,
                                                           results):
            self.keep_or_remove(number, where, scene, kind)
        return results

    def keep_or_remove(self, number, where, scene, kind):
        if kind not in RIGHT and self.arguments.keep:
            kept = os.path.join(self.arguments.keep, "%s-%d" % (
                kind.replace(" ", "-"), number))
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(where, kept)
            if os.path.dirname(scene) != where:
                shutil.copy(scene, kept)
        if os.path.dirname(scene) != where:
            os.remove(scene)
        shutil.rmtree(where)

    @staticmethod
    def judge(code, answer, is_run=False):
        if "Sanitizer" in answer or "runtime error:" in answer:
            return "sanitizer report"
        if code is None:
            # A sound scene that is large, and says so.
            return "large" if LARGE in answer else "no answer in time"
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
    parser.add_argument("--inputs", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", choices=("scenes", "meshes"))
    parser.add_argument("--batch", type=int, default=50)
    parser.add_argument("--runs", type=float, default=0.1,
                        help="share of the valid inputs that are also run")
    parser.add_argument("--timeout", type=float, default=20.,
                        help="seconds of the processor for each input")
    parser.add_argument("--memory", type=int, default=2, help="limit in GB")
    parser.add_argument("--keep", default="fuzz-findings")
    arguments = parser.parse_args()
    arguments.program = os.path.abspath(arguments.program)
    with open(arguments.program, "rb") as program:
        arguments.sanitized = b"__asan_init" in program.read()
    counts = {}
    with tempfile.TemporaryDirectory(prefix="sabot-fuzz-") as folder:
        fuzzer = Fuzzer(arguments, folder)
        if arguments.only != "meshes":
            fuzzer.find_scenes()
        print("%d scenes, %d meshes" % (len(fuzzer.scenes), len(fuzzer.meshes)))
        end = arguments.first + arguments.inputs
        batches = [range(a, min(a + arguments.batch, end))
                   for a in range(arguments.first, end, arguments.batch)]
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            for numbers, results in zip(batches,
                                        pool.map(fuzzer.batch, batches)):
                for number, (kind, command, answer) in zip(numbers, results):
                    counts[kind] = counts.get(kind, 0) + 1
                    if kind not in RIGHT:
                        print("input %d: %s: %s\n%s" % (
                            number, kind, command, answer[-1000:]), flush=True)
    print(", ".join("%s: %d" % item for item in sorted(counts.items())))
    bad = sum(n for kind, n in counts.items()
              if kind not in RIGHT)
    if bad:
        print("%d wrong of %d; kept in %s" % (bad, arguments.inputs,
                                              arguments.keep))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
