"""Flights on an emulated processor with AVX-512, which this machine need not have. bochs emulates it, a kernel from
Debian's archive runs dispersa on it, and every cases.csv must have the same bytes as one flown here.

usage: emulated_flights.py DISPERSA CAMPAIGNS WORK_FOLDER
Exit code 0: all the same; 1: not. The emulator computes a flight in about 6 s of CPU: six minutes in
all on an idle machine.
"""
import hashlib
import itertools
import json
import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import sys
import time

BUSYBOX = pathlib.Path("/bin/busybox")
LOADER = [pathlib.Path("/usr/lib/ISOLINUX/isolinux.bin"), pathlib.Path("/usr/lib/syslinux/modules/bios/ldlinux.c32")]
PROGRAMS = ["apt-get", "bochs", "dpkg-deb", "genisoimage", "ldd"]
KERNEL = "linux-image-cloud-amd64"  # the smallest of Debian's kernels; the serial port is built in
LIMIT_S = 5400  # of the emulation; other work on the machine slows it
# Campaign, instruction set, lanes. v3 is there to tell a mistake of the emulator from one of v4's code.
RUNS = [("table3", "v4", 8), ("full", "v4", 8), ("aero20", "v4", 8), ("table3", "v4", 4), ("full", "v4", 4),
        ("table3", "v4", 1), ("table3", "v3", 4)]
FLY = ["--workers", "0", "--threads", "1", "--no-histories", "--quiet", "--cases"]


def cases_of(lanes):
    """More than lanes, so that a lane that has ended takes another flight."""
    return lanes + 2



BOCHS = """\
display_library: term
romimage: file=/usr/share/bochs/BIOS-bochs-latest
vgaromimage: file=/usr/share/bochs/VGABIOS-lgpl-latest
cpu: model=corei7_skylake_x, count=1, ips=50000000, reset_on_triple_fault=0, ignore_bad_msrs=1
megs: 512
clock: sync=none
ata0-master: type=cdrom, path=boot.iso, status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev=serial.txt
log: bochs.txt
panic: action=fatal
error: action=report
info: action=ignore
speaker: enabled=0
"""
# The emulated processor tells the standard size of a compacted XSAVE area, upon which Linux would do without AVX:
# it is not to use compacted ones. Self-tests and certificates are left out, which nothing here needs.
KERNEL_OPTIONS = ("console=ttyS0 quiet nosmp mitigations=off clearcpuid=xsaves,xsavec cryptomgr.notests "
                  "initcall_blacklist=trace_eval_init,load_system_certificate_list")
# For the same reason the dynamic linker binds at the start: its trampoline saves registers compacted.
INIT = """\
#!/bin/busybox sh
/bin/busybox mount -t proc proc /proc
export LD_BIND_NOW=1
%s
echo @end
/bin/busybox sleep 2
/bin/busybox poweroff -f
"""
INIT_RUN = """\
export DISPERSA_ISA={isa} DISPERSA_LANES={lanes}
echo @begin {number} $(/bin/dispersa --version --json)
/bin/dispersa run /campaigns/{campaign}.yaml {fly} {cases} --out /tmp/{number} >/dev/null
echo @exit {number} $?
echo @digest {number} $(/bin/busybox sha256sum /tmp/{number}/cases.csv)
"""


def output(*command, **options):
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, **options).stdout


def fly_here(dispersa, campaign, folder):
    """{cases: SHA-256 of their cases.csv}; by the instruction set that every machine has."""
    counts = {cases_of(lanes) for name, _, lanes in RUNS if name == campaign.stem}
    out = folder / f"here_{campaign.stem}"
    shutil.rmtree(out, ignore_errors=True)
    # Its verdict is the exit code.
    subprocess.run([dispersa, "run", campaign, *FLY, str(max(counts)), "--out", out], stdout=subprocess.DEVNULL,
                   timeout=600, check=False, env={**os.environ, "DISPERSA_ISA": "v3", "DISPERSA_LANES": "4"})
    rows = (out / "cases.csv").read_bytes().splitlines(keepends=True)
    # A row does not depend on how many cases a campaign has.
    return {cases: hashlib.sha256(b"".join(rows[:1 + cases])).hexdigest() for cases in counts}


def refused_here(dispersa):
    """What is wrong with how this machine takes DISPERSA_ISA=v4."""
    flags = re.search(r"^flags\s*:(.*)", pathlib.Path("/proc/cpuinfo").read_text(), re.M).group(1).split()
    has_v4 = all(f"avx512{part}" in flags for part in ("f", "bw", "cd", "dq", "vl"))
    told = subprocess.run([dispersa, "--version", "--json"], capture_output=True, text=True, check=False,
                          env={**os.environ, "DISPERSA_ISA": "v4"})
    if has_v4:
        return [] if told.returncode == 0 else ["DISPERSA_ISA=v4 is refused though this processor has it"]
    expected = "DISPERSA_ISA=v4: no engine of this build on this processor, allowed: v3 1, v3 4, v3 8"
    if told.returncode == 2 and expected in told.stderr:
        return []
    return [f"this processor lacks v4, but DISPERSA_ISA=v4 gives exit code {told.returncode}: {told.stderr}"]


def kernel(folder):
    """The kernel's file, unpacked from its package and never installed."""
    found = sorted(folder.glob("kernel/boot/vmlinuz-*"))
    if found:
        return found[-1]
    package = re.search(r"Depends: (linux-image-\S+)", output("apt-cache", "depends", KERNEL)).group(1)
    for old in folder.glob("linux-image-*.deb"):
        old.unlink()
    output("apt-get", "download", package, cwd=folder)
    output("dpkg-deb", "--extract", *folder.glob("linux-image-*.deb"), folder / "kernel")
    return next(folder.glob("kernel/boot/vmlinuz-*"))


def archive(files):
    """A cpio archive (newc), as the kernel takes it for its first file system, of {path: bytes}."""
    parts = []
    numbers = itertools.count(1)

    def add(path, mode, data=b"", device=(0, 0)):
        name = path.encode() + b"\0"
        head = (next(numbers), mode, 0, 0, 1, 0, len(data), 0, 0, *device, len(name), 0)
        entry = b"070701" + b"".join(b"%08x" % value for value in head) + name
        for part in (entry, data):
            parts.append(part + b"\0" * (-len(part) % 4))

    folders = {str(parent) for path in files for parent in pathlib.PurePath(path).parents} - {"."}
    for path in sorted(folders | {"dev", "proc", "tmp"}):
        add(path, 0o040755)
    add("dev/console", 0o020600, device=(5, 1))
    add("dev/null", 0o020666, device=(1, 3))
    for path, data in files.items():
        add(path, 0o100755, data)
    add("TRAILER!!!", 0)
    return b"".join(parts)


def write_boot_disk(folder, dispersa, campaigns):
    """boot.iso: the kernel and a file system with dispersa, the libraries that it needs, and the campaigns."""
    files = {path.lstrip("/"): pathlib.Path(path).read_bytes()
             for path in re.findall(r"(/\S+) \(0x", output("ldd", dispersa))}
    files["bin/dispersa"] = dispersa.read_bytes()
    files["bin/busybox"] = BUSYBOX.read_bytes()
    for path in campaigns.rglob("*"):
        if path.is_file() and path.suffix != ".png":
            files[f"campaigns/{path.relative_to(campaigns)}"] = path.read_bytes()
    runs = [INIT_RUN.format(number=number, campaign=campaign, isa=isa, lanes=lanes, fly=" ".join(FLY),
                            cases=cases_of(lanes))
            for number, (campaign, isa, lanes) in enumerate(RUNS)]
    files["init"] = (INIT % "".join(runs)).encode()

    disk = folder / "disk"
    shutil.rmtree(disk, ignore_errors=True)
    disk.mkdir()
    (disk / "initrd").write_bytes(archive(files))
    (disk / "isolinux.cfg").write_text("DEFAULT dispersa\nPROMPT 0\nLABEL dispersa\nKERNEL /vmlinuz\nINITRD /initrd\n"
                                       f"APPEND {KERNEL_OPTIONS}\n")
    shutil.copy(kernel(folder), disk / "vmlinuz")
    for path in LOADER:
        shutil.copy(path, disk)
    output("genisoimage", "-quiet", "-o", folder / "boot.iso", "-b", "isolinux.bin", "-c", "boot.cat", "-no-emul-boot",
           "-boot-load-size", "4", "-boot-info-table", disk)


def emulate(folder):
    """Boots the disk; yields what the guest says on lines that begin with @, until it ends."""
    (folder / "bochsrc").write_text(BOCHS)
    (folder / "debugger").write_text("continue\n")  # Debian's bochs has its debugger, which waits before the first step
    serial = folder / "serial.txt"
    serial.unlink(missing_ok=True)
    screen, terminal = pty.openpty()
    begin = time.monotonic()
    bochs = subprocess.Popen(["bochs", "-q", "-f", "bochsrc", "-rc", "debugger"], cwd=folder, stdin=terminal,
                             stdout=terminal, stderr=terminal, env={**os.environ, "TERM": "linux"})
    os.close(terminal)
    told = 0
    said = b""
    opened, screens = [screen], [screen]
    try:
        while time.monotonic() - begin < LIMIT_S:
            ended = bochs.poll() is not None
            # Says nothing of interest, but a screen that nobody reads stops the emulator when it is full. Besides the
            # one that it is given, it makes one of its own and tells its name.
            for readable in select.select(screens, [], [], 1.0)[0]:
                try:
                    text = os.read(readable, 65536)
                except OSError:
                    screens.remove(readable)  # the emulator has closed it
                    continue
                if len(opened) > 1:
                    continue
                said += text
                if own := re.search(rb'connected to screen "(/dev/pts/\d+)"', said):
                    opened.append(os.open(own.group(1), os.O_RDONLY | os.O_NOCTTY | os.O_NONBLOCK))
                    screens.append(opened[-1])
            lines = serial.read_text(errors="replace").split("\n")[:-1] if serial.exists() else []
            for line in lines[told:]:
                if line.startswith("@"):
                    print(f"{time.monotonic() - begin:6.0f} s  {line.strip()}", flush=True)
                    yield line.strip()[1:]
            told = len(lines)
            if ended or any(line.startswith("@end") for line in lines):
                return
    finally:
        bochs.kill()
        bochs.wait()
        for each in opened:
            os.close(each)


def judge(lines, expected, version):
    """What is wrong with what the guest said: `expected` has the SHA-256 of cases.csv by campaign and number of
    cases, `version` is what dispersa says of itself here."""
    problems = []
    digests = [digest for by_cases in expected.values() for digest in by_cases.values()]
    if len(set(digests)) != len(digests):
        problems.append("two campaigns have the same results: the comparison could not fail")
    found = {}
    for line in lines:
        what, _, rest = line.partition(" ")
        number, _, text = rest.partition(" ")
        found[what, number] = text
    if ("end", "") not in found:
        problems.append("the emulated machine came to no end: see serial.txt and bochs.txt in the work folder")
    for number, (campaign, isa, lanes) in enumerate(RUNS):
        label = f"{campaign} with {isa} in {lanes} lanes"
        told = found.get(("begin", str(number)))
        digest = found.get(("digest", str(number)), "").partition(" ")[0]
        if told is None or json.loads(told) != {**version, "isa": isa, "lanes": lanes}:
            problems.append(f"{label}: flown by {told}")
        here = expected[campaign][cases_of(lanes)]
        if digest != here:
            problems.append(f"{label}: exit code {found.get(('exit', str(number)))}, cases.csv has "
                            f"{digest or 'not come'}, here {here}")
    return problems


def main(dispersa, campaigns, folder):
    missing = [name for name in PROGRAMS if not shutil.which(name)]
    missing += [str(path) for path in [BUSYBOX, *LOADER] if not path.exists()]
    if missing:
        print(f"missing: {', '.join(missing)}; tests/run --long installs what this needs")
        return 1
    folder.mkdir(parents=True, exist_ok=True)
    problems = refused_here(dispersa)
    expected = {name: fly_here(dispersa, campaigns / f"{name}.yaml", folder) for name in {run[0] for run in RUNS}}
    print(json.dumps(expected, indent=2))
    version = json.loads(output(dispersa, "--version", "--json"))
    write_boot_disk(folder, dispersa, campaigns)
    problems += judge(list(emulate(folder)), expected, version)
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:])))
