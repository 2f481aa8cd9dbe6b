"""A machine that runs the disk image: emulated by QEMU, or a user-mode Linux kernel. Both hand out a
root shell on a serial line that systemd's debug generator opens; the image itself has no such shell."""

import json
import os
import select
import shutil
import socket
import subprocess
import time


class MachineError(Exception):
    pass


class Shell:
    """A root shell at the other end of a serial line. One command at a time."""

    def __init__(self, read_fd, write_fd):
        self._read_fd, self._write_fd = read_fd, write_fd
        self._count = 0
        self._unread = b""
        self.transcript = b""

    def _read_until(self, mark, limit_s):
        deadline = time.monotonic() + limit_s
        while mark not in self._unread:
            left = deadline - time.monotonic()
            if left <= 0:
                return None
            ready, _, _ = select.select([self._read_fd], [], [], min(left, 1))
            if ready:
                more = os.read(self._read_fd, 65536)
                if not more:
                    raise MachineError("the serial line is closed: the machine has ended")
                self._unread += more
                self.transcript += more
        text, self._unread = self._unread.split(mark, 1)
        return text

    def _write(self, line):
        os.write(self._write_fd, line.encode() + b"\n")

    def wait_until_there(self, limit_s):
        deadline = time.monotonic() + limit_s
        # Nothing is typed before the shell asks: firmware and boot loader take keys from this line, too,
        # and a line that nobody reads yet fills up and keeps no end of line.
        while self._read_until(b"# ", max(deadline - time.monotonic(), 0.1)) is None:
            if time.monotonic() >= deadline:
                raise MachineError(f"no prompt of a shell on the serial line within {limit_s} s: {self._unread[-300:]!r}")
        while time.monotonic() < deadline:
            # What is typed is echoed; only what the shell makes of it has the mark.
            self._write("printf 'SHELL%s\\n' _THERE")
            if self._read_until(b"SHELL_THERE", 3) is not None:
                self.run("stty -echo 2>/dev/null; PS1= PS2=; set +m; export SYSTEMD_PAGER= TERM=dumb", 30)
                return
        raise MachineError(f"no root shell on the serial line within {limit_s} s")

    def run(self, command, limit_s=60):
        """Its output and exit status."""
        self._count += 1
        self._write(f"{{ {command}\n}} 2>&1; printf 'END%s %d.\\n' _{self._count}_ $?")
        output = self._read_until(f"END_{self._count}_ ".encode(), limit_s)
        if output is None:
            raise MachineError(f"not done within {limit_s} s: {command}")
        status = self._read_until(b".", 30)
        text = output.decode(errors="replace").replace("\r", "")
        return text.strip("\n"), int(status)

    def output(self, command, limit_s=60):
        text, status = self.run(command, limit_s)
        if status != 0:
            raise MachineError(f"'{command}' ended with {status}: {text[-2000:]}")
        return text


def has_kvm():
    return os.access("/dev/kvm", os.R_OK | os.W_OK) and os.environ.get("OCTASCOPE_IMAGE_ACCEL") == "kvm"


class Qemu:
    """The image in QEMU; software emulation unless OCTASCOPE_IMAGE_ACCEL=kvm."""

    firmware = "/usr/share/OVMF/OVMF_CODE_4M.fd"
    firmware_memory = "/usr/share/OVMF/OVMF_VARS_4M.fd"

    def __init__(self, image, folder, size=(800, 600), stick=None):
        os.makedirs(folder, exist_ok=True)
        self._folder = folder
        serial, monitor = f"{folder}/serial", f"{folder}/monitor"
        # Emulated, no processor with AVX: QEMU 7.2 was the first to emulate it, and the code that Mesa
        # makes for it strays out of its textures there.
        accel = ["-accel", "kvm"] if has_kvm() else ["-accel", "tcg,thread=multi"]
        command = ["qemu-system-x86_64", "-nodefaults", "-machine", "q35", *accel,
                   "-cpu", "host,arch-capabilities=off" if has_kvm() else "Westmere", "-smp", "2", "-m", "1536",
                   "-display", "none", "-vga", "none",
                   "-device", f"virtio-gpu-pci,xres={size[0]},yres={size[1]}",
                   "-drive", f"file={image},format=raw,if=virtio,cache=writethrough",
                   "-nic", "none", "-no-shutdown",
                   "-serial", f"unix:{serial},server=on,wait=off",
                   "-qmp", f"unix:{monitor},server=on,wait=off"]
        if stick:
            command += ["-drive", f"file={stick},format=raw,if=virtio,readonly=on"]
        shutil.copy(self.firmware_memory, f"{folder}/efi-memory")
        command += ["-drive", f"if=pflash,format=raw,unit=0,readonly=on,file={self.firmware}",
                    "-drive", f"if=pflash,format=raw,unit=1,file={folder}/efi-memory"]
        self._log = open(f"{folder}/qemu.log", "wb")
        self._process = subprocess.Popen(command, stdout=self._log, stderr=self._log, stdin=subprocess.DEVNULL)
        self._serial = self._connect(serial)
        self._monitor = self._connect(monitor).makefile("rw")
        self._monitor.readline()
        self._ask("qmp_capabilities")
        self.shell = Shell(self._serial.fileno(), self._serial.fileno())

    def _connect(self, path):
        for _ in range(100):
            try:
                client = socket.socket(socket.AF_UNIX)
                client.connect(path)
                return client
            except OSError:
                client.close()
                if self._process.poll() is not None:
                    break
                time.sleep(0.1)
        raise MachineError("QEMU did not start: " + open(self._log.name).read()[-1000:])

    def _ask(self, command, **arguments):
        self._monitor.write(json.dumps({"execute": command, "arguments": arguments}) + "\n")
        self._monitor.flush()
        while True:
            answer = json.loads(self._monitor.readline())
            if "return" in answer:
                return answer["return"]
            if "error" in answer:
                raise MachineError(f"QEMU's monitor refuses {command}: {answer['error']['desc']}")

    def screenshot(self, path):
        self._ask("screendump", filename=path)
        return path

    def cut_power(self):
        """At once, with whatever is not written yet lost."""
        self._process.kill()
        self.close()

    def close(self):
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        self._serial.close()
        self._log.close()


class UserModeLinux:
    """The image under the user-mode kernel of the bench: native speed, virtual devices, one processor.
    `first` is a shell command that runs before the image's init does."""

    def __init__(self, kernel, image, folder, arguments="", first=":", memory="2G"):
        os.makedirs(folder, exist_ok=True)
        self._log = open(f"{folder}/console", "wb")
        in_memory = shutil.disk_usage("/dev/shm").free > 6e9 if os.path.isdir("/dev/shm") else False
        environment = dict(os.environ, TMPDIR="/dev/shm" if in_memory else folder)
        self._process = subprocess.Popen(
            [kernel, f"mem={memory}", f"ubda={image}", *arguments.split(),
             "con=null", "con0=null,fd:2", "ssl=null", "ssl0=fd:0,fd:1", "panic=-1",
             "init=/bin/sh", "--", "-c", f'"{first}; exec /sbin/init"'],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._log, env=environment,
            start_new_session=True, preexec_fn=self._stay_on_one_processor)
        self.shell = Shell(self._process.stdout.fileno(), self._process.stdin.fileno())

    @staticmethod
    def _stay_on_one_processor():
        # As tests/virtual_hardware/boot does, and why.
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})

    def console(self):
        with open(self._log.name, errors="replace") as log:
            return log.read()

    def close(self):
        # The kernel's processes are a session of their own.
        if self._process.poll() is None:
            os.killpg(self._process.pid, 9)
        self._process.wait()
        self._log.close()
