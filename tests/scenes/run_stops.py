#!/usr/bin/env python3
"""What stops a run: run_stops.py SABOT SOURCE_FOLDER WORK_FOLDER

Signals at any moment, folders that go away, memory that does not suffice,
several programs in one folder.
"""
import glob
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

from program import (BAR, ENVIRONMENT, SABOT, SOURCE, descendants, folder, result,
                     sabot)

SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGXCPU", "SIGUSR1", "SIGUSR2")
# A run without end: it writes fields, rows and checkpoints all the time.
ENDLESS = ("--quiet", "--set", "End time=1 s", "--set", "Outputs/fields/Interval=20 us",
           "--set", "Outputs/averages/Interval=1 us", "--set",
           "Checkpoint interval in steps=40")


def start(*arguments, ranks=1, **options):
    command = [SABOT, *arguments]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-np", str(ranks)] + command
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            universal_newlines=True, env=ENVIRONMENT, **options)


def wait_for(process, condition):
    while process.poll() is None and not condition():
        time.sleep(0.005)


def has_checkpoint(out):
    return bool(glob.glob(os.path.join(out, "checkpoint/step-*.h5")))


def errors(output):
    return [line for line in output.splitlines() if line.startswith("error: ")]


def is_alive(pid):
    """Whether a process is there and not only waits to be forgotten."""
    try:
        with open("/proc/%d/stat" % pid) as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def notes_signals(pid):
    """Whether a process has a handler of SIGUSR2."""
    try:
        with open("/proc/%d/status" % pid) as file:
            caught = [line for line in file if line.startswith("SigCgt")]
        return bool(int(caught[0].split()[1], 16) >> (signal.SIGUSR2 - 1) & 1)
    except (OSError, IndexError):
        return False


class Stops(unittest.TestCase):
    def test_each_signal_leaves_a_checkpoint(self):
        straight = folder("stops-straight")
        settings = ("--quiet", "--set", "End time=1 ms", "--set",
                    "Outputs/fields/Interval=0.5 ms")
        done = sabot("run", BAR, "-o", straight, *settings)
        self.assertEqual(done.returncode, 0, done.stdout)
        for name in SIGNALS:
            with self.subTest(name):
                out = folder("stops-" + name)
                process = start("run", BAR, "-o", out, *settings)
                wait_for(process, lambda: os.path.exists(
                    os.path.join(out, "sabot.pvd")))
                process.send_signal(getattr(signal, name))
                output = process.communicate(timeout=60)[0]
                self.assertEqual((process.returncode, output), (3, ""))
                r = result(out)
                self.assertEqual(r["status"], "interrupted")
                self.assertEqual(r["reason"], name + " asked the run to stop")
                self.assertTrue(has_checkpoint(out))
                self.assertFalse(os.path.exists(os.path.join(out, "run.lock")))
                done = sabot("resume", out, "--quiet")
                self.assertEqual(done.returncode, 0, done.stdout)
                with open(os.path.join(straight, "history.h5"), "rb") as a, \
                        open(os.path.join(out, "history.h5"), "rb") as b:
                    self.assertEqual(a.read(), b.read())

    def test_a_signal_to_one_of_two_ranks_stops_both(self):
        out = folder("stops-ranks")
        process = start("run", BAR, "-o", out, *ENDLESS, ranks=2)
        wait_for(process, lambda: has_checkpoint(out))
        ranks = [pid for pid in descendants(process.pid) if notes_signals(pid)]
        self.assertEqual(len(ranks), 2)
        os.kill(ranks[1], signal.SIGUSR1)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3)
        self.assertEqual(result(out)["status"], "interrupted")

    def test_a_signal_during_the_set_up(self):
        # Large enough for seconds of set-up; noted before libraries start.
        large = ("--set", "Bodies/block/Size=50 mm, 50 mm, 50 mm")
        for name, ranks in (("SIGTERM", 1), ("SIGHUP", 1), ("SIGUSR1", 2)):
            with self.subTest(name):
                out = folder("stops-early")
                process = start("run", BAR, "-o", out, "--quiet", *large,
                                ranks=ranks)
                listening = []
                while process.poll() is None and len(listening) < ranks:
                    listening = [pid for pid in
                                 [process.pid] + descendants(process.pid)
                                 if notes_signals(pid) and (
                                     ranks == 1 or pid != process.pid)]
                os.kill(listening[-1], getattr(signal, name))
                output = process.communicate(timeout=60)[0]
                self.assertEqual(process.returncode, 3, output)
                self.assertEqual(errors(output), [
                    "error: %s asked to stop during the set-up; nothing was run"
                    % name])
                self.assertFalse(has_checkpoint(out))
                self.assertFalse(os.path.exists(os.path.join(out, "result.json")))

    def test_an_ignored_hang_up_stays_ignored(self):
        out = folder("stops-nohup")
        process = start("run", BAR, "-o", out, "--quiet", "--set",
                        "End time=0.5 ms", preexec_fn=lambda: signal.signal(
                            signal.SIGHUP, signal.SIG_IGN))
        wait_for(process, lambda: os.path.exists(os.path.join(out, "sabot.pvd")))
        process.send_signal(signal.SIGHUP)
        output = process.communicate(timeout=60)[0]
        self.assertEqual((process.returncode, output), (0, ""))

    def test_a_reader_that_goes_away_does_not_stop_a_run(self):
        out = folder("stops-pipe")
        process = start("run", BAR, "-o", out, "--set", "End time=0.2 ms")
        process.stdout.readline()
        process.stdout.close()
        self.assertEqual(process.wait(timeout=60), 0)
        self.assertEqual(result(out)["status"], "completed")

    def test_folders_that_go_away_end_a_run(self):
        def remove(path):
            while os.path.exists(path):  # the run may add files meanwhile
                shutil.rmtree(path, ignore_errors=True)

        def move(path):
            os.rename(path, path + "-moved")

        def replace(path):
            move(path)
            os.mkdir(path)

        def put_a_file_for(path):
            move(path)
            open(path, "w").close()

        def make_unwritable(path):
            # Not even root writes into it.
            subprocess.run(["chattr", "+i", path], check=True)

        for ranks, act, what in (
                (1, remove, ""), (1, move, ""), (1, replace, ""),
                (1, remove, "checkpoint"), (1, replace, "checkpoint"),
                (1, put_a_file_for, "checkpoint"), (1, move, "fields"),
                (1, replace, "fields"), (1, make_unwritable, "checkpoint"),
                (2, move, ""), (2, remove, "checkpoint"),
                (2, replace, "checkpoint"), (2, replace, "fields")):
            with self.subTest("%s %s, %d ranks" % (act.__name__, what or "run", ranks)):
                shutil.rmtree(folder("stops-folder") + "-moved", ignore_errors=True)
                out = folder("stops-folder")
                process = start("run", BAR, "-o", out, *ENDLESS, ranks=ranks)
                wait_for(process, lambda: has_checkpoint(out) and os.path.exists(
                    os.path.join(out, "sabot.pvd")))
                path = os.path.join(out, what).rstrip("/")
                try:
                    act(path)
                except subprocess.CalledProcessError:
                    process.kill()
                    process.communicate()
                    self.skipTest("no right to make a folder immutable")
                try:
                    output = process.communicate(timeout=60)[0]
                finally:
                    process.kill()
                    if act is make_unwritable:
                        subprocess.run(["chattr", "-i", path], check=True)
                self.assertEqual(process.returncode, 4, output)
                said = errors(output)
                self.assertEqual(len(said), 1, output)
                self.assertIn(what or "stops-folder", said[0])
                if ranks == 1:
                    self.assertEqual(output.count("\n"), 1, output)

    def test_a_folder_that_is_gone_is_noticed_before_the_next_output(self):
        out = folder("stops-gone")
        process = start("run", BAR, "-o", out, "--quiet", "--set", "End time=1 s",
                        "--set", "Outputs/fields/Interval=1 s", "--set",
                        "Outputs/averages/Interval=1 s")
        # What is written at the start stands there.
        wait_for(process, lambda: os.path.exists(os.path.join(out, "history.h5")))
        shutil.rmtree(out)
        output = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, 4, output)
        self.assertIn("is gone: No such file or directory", output)

    def test_memory_that_does_not_suffice_is_told_by_what_it_was_for(self):
        gigabyte = 2 ** 30
        # Sizes below what is refused before by the count of particles.
        for ranks, size in ((1, 60), (2, 68)):
            out = folder("stops-memory")
            process = start(
                "run", BAR, "-o", out, "--quiet", "--set",
                "Bodies/block/Size=%d mm, %d mm, %d mm" % (size, size, size),
                ranks=ranks, preexec_fn=lambda: resource.setrlimit(
                    resource.RLIMIT_AS, (gigabyte, gigabyte)))
            output = process.communicate(timeout=120)[0]
            self.assertEqual(process.returncode, 5, output)
            for line in errors(output):
                self.assertRegex(line, r'memory does not suffice for (the fields of )?'
                                       r'"Bodies/block"'
                                       r".* and may have 1.07 GB \(ulimit -v\)")
            self.assertGreater(len(errors(output)), 0, output)
            self.assertNotIn("terminate", output)

    def test_a_folder_belongs_to_one_run_at_a_time(self):
        out = folder("stops-lock")
        process = start("run", BAR, "-o", out, *ENDLESS)
        wait_for(process, lambda: has_checkpoint(out))
        for arguments in (("run", BAR, "-o", out), ("resume", out)):
            done = sabot(*arguments, "--quiet")
            self.assertEqual(done.returncode, 4, done.stdout)
            self.assertEqual(done.stdout, 'error: folder "%s" is in use by another '
                             "run (process %d)\n" % (out, process.pid))
        # The system takes the lock from one that is killed.
        process.kill()
        process.communicate()
        process = start("resume", out)
        wait_for(process, lambda: "resumed at step" in process.stdout.readline())
        process.send_signal(signal.SIGTERM)
        output = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, 3, output)
        self.assertFalse(os.path.exists(os.path.join(out, "run.lock")))


class Resumes(unittest.TestCase):
    def test_checkpoints_of_another_run_are_told_apart(self):
        def text(path):
            with open(path, "rb") as file:
                return file.read()

        settings = ("--quiet", "--set", "End time=0.1 ms")
        own, other = folder("stops-own"), folder("stops-other")
        done = sabot("run", BAR, "-o", own, *settings, "--set",
                     "Checkpoint interval in steps=100")
        self.assertEqual(done.returncode, 0, done.stdout)
        # Its steps are shorter, so its numbers are higher.
        done = sabot("run", BAR, "-o", other, *settings, "--set",
                     "Checkpoint interval in steps=100", "--set",
                     "Bodies/block/Nodal spacing=0.8333 mm")
        self.assertEqual(done.returncode, 0, done.stdout)
        history = text(os.path.join(own, "history.h5"))
        parameters = text(os.path.join(own, "parameters.prm"))
        theirs = sorted(glob.glob(os.path.join(other, "checkpoint/step-*.h5")))
        ours = sorted(glob.glob(os.path.join(own, "checkpoint/step-*.h5")))
        self.assertGreater(os.path.basename(theirs[-1]), os.path.basename(ours[-1]))
        # The last one, as a run that goes on writes none at its end.
        if len(ours) > 1:
            os.remove(ours.pop())
        shutil.copy(theirs[-1], os.path.join(own, "checkpoint"))
        os.remove(os.path.join(own, "history.h5"))
        # A comment or an entry changed by hand is put back.
        with open(os.path.join(own, "parameters.prm"), "a") as file:
            file.write("set Title = by hand\n")
        done = sabot("resume", own)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("is of another run", done.stdout)
        self.assertRegex(done.stdout, "0.83.* mm.* for .*1 mm")
        self.assertIn("it is put back", done.stdout)
        self.assertEqual(text(os.path.join(own, "history.h5")), history)
        self.assertEqual(text(os.path.join(own, "parameters.prm")), parameters)
        # A folder with none of its own.
        shutil.rmtree(os.path.join(own, "checkpoint"))
        shutil.copytree(os.path.join(other, "checkpoint"),
                        os.path.join(own, "checkpoint"))
        done = sabot("resume", own, "--quiet")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("holds no checkpoint of this run", done.stdout)
        self.assertEqual(text(os.path.join(own, "parameters.prm")), parameters)
        # Where a run ends and when it saves itself make no other run.
        done = sabot("resume", other, "--quiet", "--set", "End time=0.12 ms")
        self.assertEqual(done.returncode, 0, done.stdout)
        done = sabot("resume", other, "--quiet", "--set", "End time=0.13 ms")
        self.assertEqual(done.returncode, 0, done.stdout)


    def test_a_run_that_was_killed_before_its_result_gets_it(self):
        out = folder("stops-result")
        done = sabot("run", BAR, "-o", out, "--quiet", "--set", "End time=50 us")
        self.assertEqual(done.returncode, 0, done.stdout)
        r = result(out)
        with open(os.path.join(out, "history.h5"), "rb") as file:
            history = file.read()
        os.remove(os.path.join(out, "result.json"))
        with open(os.path.join(out, "history.h5"), "wb") as file:
            file.write(history[:len(history) // 2])
        done = sabot("resume", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stdout)
        for key in ("status", "steps", "time", "bodies", "energy"):
            self.assertEqual(result(out)[key], r[key])
        with open(os.path.join(out, "history.h5"), "rb") as file:
            self.assertEqual(file.read(), history)


class Studies(unittest.TestCase):
    STUDY = os.path.join(SOURCE, "tests/scenes/study.prm")

    @staticmethod
    def settings(end, factors="0.9; 0.8", ranks=1):
        return ("--set", "Parameters/spacing/Values=1.25 mm", "--set",
                "Parameters/step factor/Values=" + factors, "--set",
                "Parameters/material/Values=2700 kg/m^3 | metal", "--set",
                "Parameters/material/Labels=metal", "--set", "Pictures=false",
                "--set", "Ranks per run=%d" % ranks, "--set",
                "Fixed entries=End time=%s; Outputs/fields/Interval=%s;"
                "Outputs/averages/Interval=0.1 ms" % (end, end))

    def test_runs_end_with_their_study(self):
        # Killed without a chance to pass anything on, and asked to stop.
        for name, ranks in (("SIGKILL", 1), ("SIGKILL", 2), ("SIGHUP", 1),
                            ("SIGUSR1", 2)):
            with self.subTest("%s, %d ranks" % (name, ranks)):
                out = folder("stops-study")
                process = start("study", self.STUDY, "-o", out, "--processes", "2",
                                *self.settings("1 s", ranks=ranks))
                wait_for(process, lambda: len(glob.glob(
                    os.path.join(out, "runs/*/sabot.pvd"))) == 2)
                started = descendants(process.pid)
                self.assertGreaterEqual(len(started), 2 * ranks)
                process.send_signal(getattr(signal, name))
                process.communicate(timeout=60)
                self.assertEqual(process.returncode,
                                 -9 if name == "SIGKILL" else 3)
                end = time.time() + 60.
                while any(is_alive(pid) for pid in started):
                    self.assertLess(time.time(), end, "runs go on")
                    time.sleep(0.05)
                if (name, ranks) == ("SIGKILL", 2):
                    continue  # an mpirun may kill its ranks within a second
                for run in glob.glob(os.path.join(out, "runs/*")):
                    self.assertEqual(result(run)["status"], "interrupted")
                    self.assertTrue(has_checkpoint(run))

    def test_two_studies_share_their_runs_at_the_same_time(self):
        runs = folder("stops-shared")
        studies = []
        for s, factors in enumerate(("0.9; 0.8; 0.7", "0.7; 0.8; 0.9; 0.6")):
            out = folder("stops-shared-%d" % s)
            studies.append(start("study", self.STUDY, "-o", out, "--runs", runs,
                                 "--processes", "2",
                                 *self.settings("1 ms", factors)))
        said = [study.communicate(timeout=240)[0] for study in studies]
        for study, output, n in zip(studies, said, (3, 4)):
            self.assertEqual(study.returncode, 0, output)
            self.assertIn("%d of %d runs complete" % (n, n), output)
        names = os.listdir(runs)
        self.assertEqual(len(names), 4)
        for name in names:
            with open(os.path.join(runs, name, "log.txt")) as file:
                self.assertEqual(file.read().count("completed:"), 1)
            self.assertFalse(glob.glob(os.path.join(runs, name, "*.lock")))

    def test_a_damaged_result_counts_as_none(self):
        out = folder("stops-damaged")
        settings = self.settings("20 us")
        done = sabot("study", self.STUDY, "-o", out, *settings)
        self.assertEqual(done.returncode, 0, done.stdout)
        runs = sorted(glob.glob(os.path.join(out, "runs/*")))
        with open(os.path.join(runs[0], "result.json")) as file:
            good = file.read()
        for bad in ("", "{}", "[]", "null", "12", '{"status": 3}', good[:-20],
                    '{"status": "done"}', "\xff{}"):
            with open(os.path.join(runs[0], "result.json"), "w",
                      encoding="latin-1") as file:
                file.write(bad)
            done = sabot("study", self.STUDY, "-o", out, *settings)
            self.assertEqual(done.returncode, 0, bad + done.stdout)
            self.assertIn("2 runs, 1 of them kept", done.stdout)
        # What says that it is complete is believed, whatever else it lacks.
        for bad in ('{"status": "completed"}',
                    '{"status": "completed", "bodies": 3, "energy": [1], '
                    '"zone": {"a": 1}, "quantities": {"speed": [2]}}'):
            with open(os.path.join(runs[0], "result.json"), "w") as file:
                file.write(bad)
            with open(os.path.join(runs[0], "history.h5"), "w") as file:
                file.write("no history")
            done = sabot("study", self.STUDY, "-o", out, *settings)
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertIn("2 of them kept", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
