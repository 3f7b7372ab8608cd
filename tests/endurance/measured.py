# SPDX-License-Identifier: BSD-3-Clause
"""What endure and service-kills observe of isobard from outside, and how they report it."""

import bisect
import re
import subprocess
import threading
import time

POSE = re.compile(r"t ([-0-9.]+) s\s+x\s+([-0-9.]+)\s+y\s+([-0-9.]+)\s+z\s+([-0-9.]+)")
FRAME = re.compile(r"tf\s+t [-0-9.]+ s\s+(\S+) -> (\S+)")
TILES = re.compile(r"^tiles: ([0-9]+)", re.MULTILINE)


def tiles_in(said):
    """Tiles of a map on the disk, from what `isobar map info` says; 0: no map."""
    found = TILES.search(said)
    return int(found[1]) if found else 0


def undisturbed_error_m(isobar, recording, scratch):
    """Largest distance of a pose from the truth when nothing happens to the run: that of its replay.

    isobar: the program, as a list of arguments; scratch: a folder of its machine, for the run."""
    subprocess.run([*isobar, "replay", str(recording), "--out", scratch], capture_output=True, check=True)
    said = subprocess.run([*isobar, "evaluate", f"{recording}/reference.tum", scratch, "--json", "/dev/stdout"],
                          capture_output=True, text=True, check=True).stdout
    return float(re.search(r'"ate_max_m": *([-0-9.e]+)', said)[1])


class Poses:
    """Arrival times and positions of the poses, from `isobar echo`, which is a DDS subscriber."""

    def __init__(self, isobar):
        """isobar: the program, as a list of arguments."""
        self.lock = threading.Lock()
        self.arrivals = []  # (monotonic time [s], stamp [s], x, y, z [m])
        self.frames = set()
        self.process = subprocess.Popen(
            [*isobar, "echo", "pose", "tf", "--rate", "1000", "--timeout", "0"],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            now = time.monotonic()
            if frame := FRAME.search(line):
                if "odom" in frame[2]:
                    with self.lock:
                        self.frames.add(frame[1])
            elif pose := POSE.search(line):
                with self.lock:
                    self.arrivals.append((now, *map(float, pose.groups())))

    def first_after(self, moment, timeout):
        """Seconds from `moment` to the first later pose; None: none within the timeout."""
        while time.monotonic() < moment + timeout:
            with self.lock:
                for arrival in reversed(self.arrivals):
                    if arrival[0] <= moment:
                        break
                    found = arrival[0]
                else:
                    found = self.arrivals[0][0] if self.arrivals else moment
                if self.arrivals and self.arrivals[-1][0] > moment:
                    return found - moment
            time.sleep(0.01)
        return None

    def first_measured_after(self, stamp, timeout):
        """Monotonic time of the arrival of the first pose stamped after `stamp` [s, Unix]; None: none within the timeout.

        Unlike first_after() it cannot take a pose that a killed program still had under way.
        """
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            with self.lock:
                if self.arrivals and self.arrivals[-1][1] > stamp:
                    return next(arrival[0] for arrival in self.arrivals if arrival[1] > stamp)
            time.sleep(0.01)
        return None

    def longest_gap(self, since):
        """Longest time between two poses from `since` on."""
        with self.lock:
            times = [arrival[0] for arrival in self.arrivals if arrival[0] >= since]
        return max((b - a for a, b in zip(times, times[1:])), default=float("inf"))

    def waits(self, moments):
        """Seconds from each moment to the next pose that was received."""
        with self.lock:
            times = [arrival[0] for arrival in self.arrivals]
        following = [bisect.bisect_right(times, moment) for moment in moments]
        return [times[i] - moment for i, moment in zip(following, moments) if i < len(times)]

    def stop(self):
        self.process.kill()
        self.process.wait()


class Checks:
    """Prints one line a check, and at the end 'N passed, N failed'."""

    passed = 0
    failed = 0

    def check(self, good, text):
        self.passed, self.failed = self.passed + bool(good), self.failed + (not good)
        print(("ok      " if good else "FAILED  ") + text, flush=True)

    def close(self):
        print(f"{self.passed} passed, {self.failed} failed")
        return 0 if self.failed == 0 and self.passed > 0 else 1


def summary(seconds):
    ordered = sorted(seconds)
    if not ordered:
        return "none"
    p99 = ordered[min(len(ordered) - 1, int(0.99 * len(ordered)))]
    return f"median {ordered[len(ordered) // 2]:.2f} s, p99 {p99:.2f} s, longest {ordered[-1]:.2f} s"
