#!/usr/bin/env bash
# Says whether this machine can run a User-Mode Linux kernel, before anybody builds one: exit code 3 and the reason if
# it cannot.
# Usage: tests/kernel/able.sh
set -euo pipefail

refuse() {
  echo "kernel: this machine cannot run a kernel as a process: $*" >&2
  exit 3
}

[ "$(uname -m)" = x86_64 ] || refuse "User-Mode Linux runs on x86-64 only, and this is $(uname -m)"
# The kernel traces its guest's processes, which a container or a hardened system may forbid.
why=$(python3 - <<'END'
import ctypes, os
libc = ctypes.CDLL(None, use_errno=True)
reading, writing = os.pipe()
child = os.fork()
if child == 0:
    PTRACE_TRACEME = 0
    if libc.ptrace(PTRACE_TRACEME, 0, None, None) != 0:
        os.write(writing, os.strerror(ctypes.get_errno()).encode())
    os._exit(0)
os.close(writing)
os.waitpid(child, 0)
print(os.read(reading, 100).decode())
END
)
[ -z "$why" ] || refuse "ptrace is forbidden ($why). In a container: --cap-add=SYS_PTRACE;
  otherwise see /proc/sys/kernel/yama/ptrace_scope"
