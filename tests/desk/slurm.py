"""A Slurm of one node that is started and ended by a test: munge, slurmctld and slurmd of Debian's slurm-wlm."""

import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

CONFIGURATION = """ClusterName=trial
SlurmctldHost={host}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=sched_interval=5,requeue_delay=0
KillWait=10
NodeName={host} CPUs={processors} RealMemory={megabytes} State=UNKNOWN
PartitionName=trial Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue")


class MissingError(Exception):
    """The reason why no Slurm can be started here."""


def _free_ports(number):
    """Return ports that are free."""
    sockets = [socket.socket() for _ in range(number)]
    for one in sockets:
        one.bind(("", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Slurm:
    """The daemons; used with `with`, so that they end with the test."""

    def __init__(self, folder):
        """Prepare its files in a folder with a short path."""
        os.environ["PATH"] += ":/usr/sbin:/sbin"
        missing = [name for name in PROGRAMS if shutil.which(name) is None]
        if missing:
            raise MissingError(f"{', '.join(missing)} not installed (apt-get install slurm-wlm munge)")
        if os.geteuid() != 0:
            raise MissingError("only root may start Slurm's daemons")
        self.folder, self._daemons = Path(folder), []
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True)
        self.folder.chmod(0o755)
        (self.folder / "munge.key").write_bytes(os.urandom(1024))
        (self.folder / "munge.key").chmod(0o400)
        megabytes = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2**20 - 100
        text = CONFIGURATION.format(host=socket.gethostname().split(".")[0], folder=self.folder, ports=_free_ports(2),
                                    processors=os.cpu_count(), megabytes=megabytes)
        (self.folder / "slurm.conf").write_text(text, encoding="utf-8")
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))

    def __enter__(self):
        """Start the daemons and wait for the node."""
        at = self.folder
        self._start("munged", "--foreground", "--force", f"--key-file={at}/munge.key", f"--socket={at}/munge.socket",
                    f"--pid-file={at}/munge.pid", f"--log-file={at}/munge.log", f"--seed-file={at}/munge.seed")
        self.wait(lambda: (at / "munge.socket").exists(), "munge")
        self._start("slurmctld", "-D", "-c")
        self._start("slurmd", "-D")
        self.wait(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"), "the node")
        return self

    def __exit__(self, *_):
        """End jobs and started daemons, last first."""
        self.ask("scancel", "--me")
        for _ in range(40):
            if not self.ask("squeue", "-h"):
                break
            time.sleep(0.5)
        for daemon in reversed(self._daemons):
            daemon.send_signal(signal.SIGTERM)
            try:
                daemon.wait(15)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def ask(self, *words):
        """Return the output of a Slurm command; empty if it fails."""
        done = subprocess.run([str(word) for word in words], env=self.environment, capture_output=True, text=True,
                              timeout=30, check=False)
        return done.stdout if done.returncode == 0 else ""

    def submit(self, folder, script, *options, **variables):
        """Submit a script and return the job's number."""
        done = subprocess.run(["sbatch", "--parsable", *options, str(script)], cwd=folder, capture_output=True,
                              text=True, env=self.environment | variables, timeout=30, check=False)
        if done.returncode:
            raise MissingError(f"sbatch says {done.stderr.strip()}")
        return done.stdout.strip().split(";")[0]

    def job(self, number):
        """Return Slurm's record of a job, by name."""
        said = self.ask("scontrol", "show", "job", "-o", number).split()
        return dict(item.split("=", 1) for item in said if "=" in item)

    def end_of(self, number, seconds):
        """Wait for the end of a job; return its record then."""
        ends = ("COMPLETED", "FAILED", "TIMEOUT", "CANCELLED", "NODE_FAIL")
        self.wait(lambda: self.job(number).get("JobState") in ends, f"job {number}", seconds)
        return self.job(number)

    def _start(self, name, *words):
        """Start a daemon in the foreground, so that this process can end it."""
        with (self.folder / f"{name}.txt").open("wb") as output:
            self._daemons.append(subprocess.Popen([shutil.which(name), *words], env=self.environment, stdout=output,
                                                  stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL))

    def wait(self, holds, what, seconds=40):
        """Wait until a condition is met."""
        for _ in range(int(2 * seconds)):
            if holds():
                return
            dead = [daemon.args[0] for daemon in self._daemons if daemon.poll() is not None]
            if dead:
                raise MissingError(f"{dead[0]} has ended; its log is in {self.folder}")
            time.sleep(0.5)
        raise MissingError(f"{what} is not there after {seconds} s; logs are in {self.folder}")
