#!/usr/bin/env python3
"""`bin_scenes dataset submit` with the real slurmctld, slurmd and munged of Debian, started here on 127.0.0.1.
One task is killed in the middle and requeued. Skipped where they are not installed, or without root.

    slurm_test.py TOOL
"""
import os
import shutil
import signal
import socket
import subprocess
import time
import unittest

import data_set
from data_set import DataSetTest

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol")
FOUND = all(shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin") for name in PROGRAMS) and os.getuid() == 0


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    """A cluster of one node, which is this machine; its daemons are children of the test."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, []
        folder.mkdir()
        for name in ("state", "spool"):
            (folder / name).mkdir()
        cores = os.cpu_count()
        host = socket.gethostname().split(".")[0]
        munge_socket = folder / "munge/socket"
        (folder / "munge").mkdir()
        os.chmod(folder / "munge", 0o755)
        os.chmod(folder, 0o755)
        key = folder / "munge/key"
        key.write_bytes(os.urandom(128))
        os.chmod(key, 0o400)
        (folder / "slurm.conf").write_text("\n".join((
            "ClusterName=here", "SlurmctldHost=%s(127.0.0.1)" % host, "SlurmUser=root", "SlurmdUser=root",
            "AuthType=auth/munge", "AuthInfo=socket=%s,cred_expire=5" % munge_socket,  # so long a requeued task waits "CredType=cred/munge",
            "ProctrackType=proctrack/linuxproc", "TaskPlugin=task/none", "SelectType=select/cons_tres",
            "SelectTypeParameters=CR_Core", "SlurmctldPort=%d" % free_port(), "SlurmdPort=%d" % free_port(),
            "StateSaveLocation=%s" % (folder / "state"), "SlurmdSpoolDir=%s" % (folder / "spool"),
            "SlurmctldPidFile=%s" % (folder / "slurmctld.pid"), "SlurmdPidFile=%s" % (folder / "slurmd.pid"),
            "SlurmctldLogFile=%s" % (folder / "slurmctld.log"), "SlurmdLogFile=%s" % (folder / "slurmd.log"),
            "ReturnToService=2", "MpiDefault=none", "JobRequeue=1", "KillWait=2", "MinJobAge=2", "SchedulerParameters=bf_interval=1",
            "NodeName=%s NodeAddr=127.0.0.1 CPUs=%d State=UNKNOWN" % (host, cores),
            "PartitionName=main Nodes=%s Default=YES MaxTime=INFINITE State=UP" % host, "")))
        (folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\nCgroupAutomount=no\n")
        self.environment = dict(os.environ, SLURM_CONF=str(folder / "slurm.conf"), PATH=os.environ["PATH"] + ":/usr/sbin")
        self.start("munged", "--foreground", "--force", "--socket=%s" % munge_socket, "--key-file=%s" % key,
                   "--pid-file=%s" % (folder / "munge/pid"), "--seed-file=%s" % (folder / "munge/seed"),
                   "--log-file=%s" % (folder / "munge/log"))
        self.wait_for(munge_socket.exists, "munged")
        self.start("slurmctld", "-D", "-i")
        self.start("slurmd", "-D", "-N", host)
        self.wait_for(lambda: self.ask("sinfo", "-h", "-o", "%T").strip() in ("idle", "mixed"), "slurmctld and slurmd")

    def start(self, *words):
        with open(self.folder / (words[0] + ".out"), "wb") as log:
            self.daemons.append(subprocess.Popen(words, env=self.environment, stdout=log, stderr=subprocess.STDOUT))

    def ask(self, *words):
        return subprocess.run(words, env=self.environment, capture_output=True, text=True).stdout

    def wait_for(self, holds, what, seconds=120):
        end = time.monotonic() + seconds
        while not holds():
            if time.monotonic() > end or any(d.poll() is not None for d in self.daemons):
                logs = "".join("\n%s:\n%s" % (p.name, p.read_text(errors="replace")[-1500:])
                               for p in sorted(self.folder.glob("*.out")) + sorted(self.folder.glob("*.log")))
                raise AssertionError(what + " did not come up:" + logs)
            time.sleep(0.2)

    def stop(self):
        for daemon in reversed(self.daemons):
            daemon.send_signal(signal.SIGTERM)
        for daemon in self.daemons:
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()


class Commands(DataSetTest):
    """What is asked of Slurm's commands; here scripts that speak as they do."""

    def environment(self):
        return dict(os.environ, PATH=str(self.folder / "bin") + ":" + os.environ["PATH"])

    def put(self, name, text):
        (self.folder / "bin").mkdir(exist_ok=True)
        (self.folder / "bin" / name).write_text("#!/bin/bash\n" + text)
        (self.folder / "bin" / name).chmod(0o755)

    def test_words_to_the_user_are_no_job_and_a_path_may_hold_a_comma_or_a_percent_sign(self):
        self.put("sbatch", """echo "sbatch: warning: this account has 7 hours left" >&2
for word in "$@"; do
  case $word in
    --output=*) pattern=${word#--output=} ;;
    --export=*) IFS=, read -ra names <<< "${word#--export=}"
                for name in "${names[@]}"; do [[ $name == *=* ]] && export "$name"; done ;;
    --array=*) last=${word#--array=0-} ;;
  esac
done
for ((i = 0; i <= last; ++i)); do
  SLURM_ARRAY_TASK_ID=$i bash "${@: -1}" > "$(sed "s/%%/|/g; s/%a/$i/g; s/|/%/g" <<< "$pattern")" 2>&1 || exit 1
done
echo "4711;here"
""")
        self.put("squeue", """echo "squeue: warning: the daemon is slow" >&2
[[ $* == *--jobs=4711* ]] || { echo "slurm_load_jobs error: Invalid job id specified" >&2; exit 1; }
[[ -e asked ]] || echo RUNNING
touch asked
""")
        plan = self.plan(scenes=2, outputs="json")
        done = self.run_tool("dataset", "submit", plan, "--out", "bolts,2%a", "--shares", 2)
        self.assertIn("job 4711: 1 RUNNING\n", done.stdout + done.stderr)
        self.assertEqual((self.folder / "bolts,2%a/.shares/job").read_text(), "4711")
        self.assertTrue((self.folder / "bolts,2%a/.shares/share_1.log").exists())
        self.make(plan, "here")
        self.assert_same("here", "bolts,2%a")


@unittest.skipUnless(FOUND, "needs root and Debian's packages slurmctld, slurmd, slurm-client and munge")
class Slurm(DataSetTest):
    def setUp(self):
        super().setUp()
        os.chmod(self.folder, 0o755)
        self.cluster = Cluster(self.folder / "cluster")
        self.addCleanup(self.cluster.stop)

    def environment(self):
        return self.cluster.environment

    def test_an_array_job_makes_the_same_data_set_though_a_task_is_killed(self):
        plan = self.plan(scenes=24)
        submit = subprocess.Popen(self.command("dataset", "submit", "--slurm", plan, "--out", "cluster_out", "--shares", 2),
                                  cwd=self.folder, env=self.environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        share = self.folder / "cluster_out/.shares/share_0/scenes"
        self.cluster.wait_for(lambda: share.is_dir() and any(p.name.startswith("scene_") for p in share.iterdir()), "share 0", 300)
        job = (self.folder / "cluster_out/.shares/job").read_text()
        requeued = subprocess.run(["scontrol", "requeue", job + "_0"], env=self.environment(), capture_output=True, text=True)
        self.assertEqual(requeued.returncode, 0, requeued.stderr)
        out, _ = submit.communicate(timeout=600)
        self.assertEqual(submit.returncode, 0, out)
        log = (self.folder / "cluster_out/.shares/share_0.log").read_text()
        self.assertIn("start 2", log)
        print(out)
        self.make(plan, "here")
        self.assert_same("here", "cluster_out")
        self.assertIn(" 0 findings", self.run_tool("dataset", "verify", "cluster_out").stdout)


if __name__ == "__main__":
    data_set.main()
