# SPDX-License-Identifier: BSD-3-Clause
"""A clean Debian 12 that systemd boots in a container, with the isobar package installed."""

import os
import shutil
import signal
import subprocess
import tempfile
import time
import tomllib
from pathlib import Path

UNITS = ("isobard", "isobar-dds")
# Where systemd keeps groups of processes: the unified hierarchy alone, or beside an older one.
HIERARCHIES = [path for path in map(Path, ("/sys/fs/cgroup", "/sys/fs/cgroup/unified", "/sys/fs/cgroup/systemd"))
               if (path / "cgroup.procs").exists()]
# Joins the groups, then mounts the overlay, which is seen by this child only and ends with it.
ENTER = """for group in $1; do echo $$ >"$group/cgroup.procs"; done
mount -t overlay overlay -o "$2" "$3"
shift 3
exec "$@\""""


class Machine:
    """The container; its files are those of tests/vm/image below an overlay that is deleted at the end."""

    def __init__(self, image, deb, recording):
        """image: folder of tests/vm/image, made if it is not there; recording: seen as /recording inside."""
        self.image, self.deb, self.recording = image, deb, recording
        self.container = None
        # Groups of its own, because two containers with the same would stop each other's services.
        self.groups = [path / f"isobar-{os.getpid()}" for path in HIERARCHIES]
        self.work = Path(tempfile.mkdtemp(prefix="isobar-machine", dir="/var/tmp"))

    def boot(self):
        subprocess.run([Path(__file__).parents[1] / "vm/image", self.image, self.deb], check=True)
        for folder in (*self.groups, self.work / "changes", self.work / "overlay", self.work / "root"):
            folder.mkdir()
        layers = f"lowerdir={self.image}/root,upperdir={self.work}/changes,workdir={self.work}/overlay"
        # After --boot: parameters as of a kernel. There is no disk to mount, and no test of tests/vm/service to run.
        with open(self.work / "console", "w") as console:
            self.container = subprocess.Popen(
                ["unshare", "--mount", "sh", "-ec", ENTER, "boot", " ".join(map(str, self.groups)), layers,
                 self.work / "root", "systemd-nspawn", "--quiet", "--register=no", "--keep-unit", "--private-network",
                 "--console=passive", f"--machine=isobar-{os.getpid()}", f"--directory={self.work}/root",
                 f"--bind-ro={self.recording}:/recording", f"--bind-ro={self.image}/repository:/host/repository",
                 f"--bind-ro={self.deb}:/host/isobar.deb", "--boot", "fstab=no", "systemd.mask=guest.service"],
                stdin=subprocess.DEVNULL, stdout=console, stderr=console)
        self.leader = self.wait_for_boot()
        self.files = Path(f"/proc/{self.leader}/root")
        self.call("apt-get", "-qq", "update")
        self.call("env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-qq", "-y", "install", "/host/isobar.deb")
        self.configure("robot", self.mounts())

    def mounts(self):
        """Where the recording's sensors are on the robot, as TOML."""
        sensors = tomllib.loads((Path(self.recording) / "recording.toml").read_text())
        return "".join(f"{name}.{key} = {sensors[name][key]}\n" for name in ("lidar", "imu", "barometer")
                       for key in ("xyz_m", "rpy_deg") if key in sensors.get(name, {}))

    def wait_for_boot(self):
        """Process id of the container's process 1, once it has booted."""
        children = Path(f"/proc/{self.container.pid}/task/{self.container.pid}/children")
        end = time.monotonic() + 60
        while time.monotonic() < end and self.container.poll() is None:
            if leader := children.read_text().split():
                self.leader = int(leader[0])
                if self.call("systemctl", "is-system-running", check=False).strip() == "running":
                    return self.leader
            time.sleep(0.2)
        raise SystemExit("no container booted:\n" + (self.work / "console").read_text()[-2000:])

    def inside(self, *command):
        """The arguments that run a command in the container."""
        return ["nsenter", "--target", str(self.leader), "--all", *command]

    def call(self, *command, check=True):
        """Runs a command in the container; returns what it printed. check: it must succeed."""
        done = subprocess.run(self.inside(*command), capture_output=True, text=True)
        if check and done.returncode != 0:
            raise SystemExit(f"{' '.join(command)}: {done.stdout[-500:]}{done.stderr[-500:]}")
        return done.stdout

    def transient(self, name, *command):
        """A unit that runs until its command ends, and is then forgotten."""
        self.call("systemctl", "stop", name, check=False)
        self.call("systemd-run", "-q", f"--unit={name}", "--collect", *command)

    def states(self, key):
        """A property of both services."""
        return self.call("systemctl", "show", "--value", "-p", key, *UNITS).split()

    def configure(self, name, text):
        """A file of conf.d, replaced at once."""
        folder = self.files / "etc/isobar/conf.d"
        (folder / f".{name}").write_text(text)
        os.replace(folder / f".{name}", folder / f"{name}.toml")

    def shared_files(self):
        """Number of the files that could leak, a folder: the services' shared memory and sockets, and the machine's. Not
        counted: folders of PrivateTmp=, which systemd makes and removes."""
        return {folder: sum(not name.startswith("systemd-private-") for name in os.listdir(self.files / folder))
                for folder in ("run/isobar/shm", "run/isobar/tmp", "dev/shm", "tmp")}

    def close(self):
        if self.container:
            self.container.send_signal(signal.SIGTERM)  # powers it off
            try:
                self.container.wait(30)
            except subprocess.TimeoutExpired:
                os.kill(self.leader, signal.SIGKILL)
                self.container.wait()
        for group in self.groups:
            for folder, _, _ in os.walk(group, topdown=False):
                os.rmdir(folder)
        shutil.rmtree(self.work, ignore_errors=True)
