#!/usr/bin/env bash
# Boots Debian's 64-bit ARM kernel on an emulated machine and runs there what was built for it: the tests of the real
# backends, on gpio-sim and the modules beside this script, and the program itself, on the machine's own GPIO chip (an
# ARM PL061). The guest sees the host's files read-only. Exit code 1 if anything failed.
# Usage: tests/kernel/aarch64_run.sh FOLDER BUILD
#   FOLDER  as tests/kernel/aarch64_build.sh prints it
#   BUILD   the build tree of preset aarch64
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$1
build=$(realpath "$2")
seconds=900 # a guest that hangs is ended

work=$(mktemp -d "${TMPDIR:-/tmp}/forager-aarch64.XXXXXX")
trap 'rm -rf "$work"' EXIT
root=$work/root
mkdir -p "$root/bin"
cp "$folder/busybox" "$root/bin/busybox"
cp -r "$folder/modules" "$root/modules"
cp "$here/aarch64_guest.sh" "$root/init"
cat >"$root/job" <<EOJ
failed=0
# try NAME TEXT COMMAND ...: the command succeeds and says the text.
try() {
  name=\$1 text=\$2
  shift 2
  echo "[ RUN      ] \$name"
  if "\$@" >/tmp/out 2>&1 && grep -qF -- "\$text" /tmp/out; then
    echo "[       OK ] \$name (0 ms)"
  else
    cat /tmp/out
    echo "[  FAILED  ] \$name (0 ms)"
    failed=1
  fi
}
# No udev here, and no virtual time.
/h$build/tests/kernel_tests --gtest_color=no \
  --gtest_filter='Gpio*:*Digital*:*Pwm*:I2c*:-*InVirtualTime*:*NobodyMay*:*WithoutTheRight*:*WhatCannotBeOpened*' ||
  failed=1
try Program.NamesItsCommands doctor /h$build/tools/forager --help
try Program.ReadsThePinsOfTheMachine 9030000.pl061 /h$build/tools/forager gpio list
try Program.ExaminesItself gpio /h$build/tools/forager doctor
exit \$failed
EOJ
(cd "$root" && find . | cpio -o -H newc --quiet | gzip -1) >"$work/initrd"

log=$work/log
timeout -k 5 "$seconds" qemu-system-aarch64 -M virt -cpu cortex-a72 -m 768 -accel tcg -display none -serial stdio \
  -monitor none -no-reboot -nic none -kernel "$folder/vmlinuz" -initrd "$work/initrd" -append "console=ttyAMA0 panic=-1 quiet" \
  -virtfs local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap </dev/null 2>&1 |
  tr -d '\r' | tee "$log"
grep -qx 'JOB-RC 0' "$log"
