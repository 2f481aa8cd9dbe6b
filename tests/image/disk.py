"""Copies of the disk image for a test, with a configuration on the data partition and more said to the
kernel; the copy's root is left as it is."""

import os
import re
import shutil
import subprocess

SECTOR = 512


def run(*command, **more):
    return subprocess.run(command, check=True, capture_output=True, **more).stdout


class Disk:
    def __init__(self, image, path):
        subprocess.run(["cp", "--sparse=always", "--reflink=auto", image, path], check=True)
        self.path = path
        self._parts = {}
        for line in run("sfdisk", "-d", path).decode().splitlines():
            found = re.search(r'start= *(\d+), size= *(\d+).*name="octascope-(\w+)"', line)
            if found:
                self._parts[found[3]] = (int(found[1]) * SECTOR, int(found[2]) * SECTOR)

    def _efi(self):
        return f"{self.path}@@{self._parts['efi'][0]}"

    def say_to_kernel(self, arguments):
        """More on the kernel's command line, through the boot loader's file."""
        rules = run("mtype", "-i", self._efi(), "::octascope/grub.cfg").decode()
        changed = re.sub(r"( linux /boot/vmlinuz [^;]*)", r"\1 " + arguments, rules, count=1)
        assert changed != rules
        self._put_on_efi("grub.cfg", changed.encode())

    def _put_on_efi(self, name, content):
        scratch = self.path + ".efi"
        with open(scratch, "wb") as file:
            file.write(content)
        run("mcopy", "-o", "-i", self._efi(), scratch, f"::octascope/{name}")
        os.remove(scratch)

    def boot_memory(self, *changes):
        """What the boot loader remembers, after the changes ("A_TRY=3", …)."""
        scratch = self.path + ".grubenv"
        with open(scratch, "wb") as file:
            file.write(run("mtype", "-i", self._efi(), "::octascope/grubenv"))
        if changes:
            run("grub-editenv", scratch, "set", *changes)
            with open(scratch, "rb") as file:
                self._put_on_efi("grubenv", file.read())
        lines = run("grub-editenv", scratch, "list").decode().splitlines()
        os.remove(scratch)
        return dict(line.split("=", 1) for line in lines)

    def ruin(self, part, size=1 << 20):
        """Zeros over the beginning of a partition."""
        with open(self.path, "r+b") as disk:
            disk.seek(self._parts[part][0])
            disk.write(bytes(size))

    def _data(self):
        """The data partition in a file of its own, and how it is put back."""
        scratch = self.path + ".data"
        start, size = self._parts["data"]
        run("dd", f"if={self.path}", f"of={scratch}", "bs=1M", f"skip={start >> 20}",
            f"count={size >> 20}", "conv=sparse")
        return scratch

    def put_configuration(self, file, name="octascope.toml"):
        scratch = self._data()
        # What a cut of the power left to be replayed would be replayed over what is written here.
        subprocess.run(["e2fsck", "-p", "-E", "journal_only", scratch], capture_output=True)
        run("debugfs", "-w", "-f", "-", scratch,
            input=f"rm /etc/upper/{name}\nwrite {file} /etc/upper/{name}\n"
                  f"sif /etc/upper/{name} mode 0100644\n".encode())
        run("dd", f"if={scratch}", f"of={self.path}", "bs=1M", f"seek={self._parts['data'][0] >> 20}", "conv=notrunc")
        os.remove(scratch)

    def data_is_sound(self):
        """What a check of the data partition says: empty when there is nothing to mend. The journal is
        replayed first, as the next mount would."""
        scratch = self._data()
        subprocess.run(["e2fsck", "-p", "-E", "journal_only", scratch], capture_output=True)
        checked = subprocess.run(["e2fsck", "-f", "-n", scratch], capture_output=True)
        os.remove(scratch)
        return "" if checked.returncode == 0 else checked.stdout.decode()

    def remove(self):
        if os.path.exists(self.path):
            os.remove(self.path)
