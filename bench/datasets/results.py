"""Tables in the form of bench/framework: comments about machine and command, then rows that replace those of the same
keys. What the scripts of this folder share."""
import csv
import datetime
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESULTS = ROOT / os.environ.get("BIN_SCENES_RESULTS", "bench/results")


def cpu():
    names = re.findall(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return re.sub(r"\((R|TM|tm)\)| (Processor|CPU).*", "", names[0]) if names else "unknown"


def device_folder():
    return RESULTS / ("%s-%d-cores" % (re.sub(r"\W+", "-", cpu().lower()), os.cpu_count()))


def commit():
    def git(*words):
        return subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True).stdout.strip()
    dirty = git("status", "--porcelain", "--untracked-files=no", "--", "src", "include", "CMakeLists.txt", "python")
    return git("rev-parse", "--short=10", "HEAD") + ("-dirty" if dirty else "")


def version():
    return re.search(r"project\(bin_scenes VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def timed(*words):
    """Wall and processor seconds of a command that says nothing; ends the script if it fails."""
    begin = time.monotonic()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status:
        sys.exit("%s: the run failed" % os.path.basename(sys.argv[0]))
    return time.monotonic() - begin, used.ru_utime + used.ru_stime


def put(name, about, keys, rows, measures):
    """Writes rows (dicts with the same names) into the table `name` of this machine. When the folders `measures` of the
    source tree change, bench/publish marks the table as stale."""
    path = device_folder() / (name + ".csv")
    rows = [dict(row, commit=commit()) for row in rows]
    fields = list(rows[0])
    if path.exists():
        old = list(csv.DictReader(line for line in path.open() if not line.startswith("#")))
        new = {tuple(str(row[key]) for key in keys): row for row in rows}
        kept = [new.pop(tuple(row[key] for key in keys), row) for row in old]
        rows = kept + list(new.values())
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w") as out:
        for key, value in (("benchmark", name), ("about", about), ("command", os.path.relpath(os.path.abspath(sys.argv[0]), ROOT)),
                           ("measures", measures), ("cpu", cpu()), ("cores", os.cpu_count()), ("version", version()), ("commit", commit()),
                           ("date", datetime.date.today()), ("roles", " ".join("key" if f in keys else "info" for f in fields))):
            out.write("# %s: %s\n" % (key, value))
        writer = csv.DictWriter(out, fields, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print("%s: %d rows" % (path.relative_to(ROOT), len(rows)))
