#!/usr/bin/env bash
# Boots a User-Mode Linux kernel and runs the tests of the real backends in it: once in real time, once in virtual time,
# where the clock only moves while everybody waits, so that stamps of the kernel are exact. The guest sees the host's
# files read-only; neither needs root. The output is the tests' own; exit code 1 if one failed.
# Usage: tests/kernel/run.sh KERNEL_FOLDER PROGRAM [GUEST [FILTER]]
#   KERNEL_FOLDER  as tests/kernel/build.sh prints it
#   PROGRAM        kernel_tests
#   GUEST          only this guest: real or virtual
#   FILTER         of GoogleTest, instead of the guest's own
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
kernel=${1:?tests/kernel/run.sh: needs the folder of a kernel and the program}
program=$(realpath "${2:?tests/kernel/run.sh: needs the program of the tests}")
only=${3:-}
filter=${4:-}
seconds=600 # a guest that hangs is ended
megabytes=384

work=$(mktemp -d "${TMPDIR:-/tmp}/forager-kernel.XXXXXX")
trap 'rm -rf "$work"' EXIT

# The guest's memory is a file, best one in memory. A container's /dev/shm is small, and nothing may be run from it.
memory=/dev/shm
room=$(df -m --output=avail "$memory" 2>/dev/null | tail -n 1)
options=$(awk -v folder="$memory" '$2 == folder { options = $4 } END { print options }' /proc/mounts)
if [ "${room:-0}" -lt "$megabytes" ] || [[ ",$options," == *,noexec,* ]]; then memory=$work; fi

ln -s "$here/guest.sh" "$work/init"
ln -s "$program" "$work/program"
ln -s "$here"/../../boards/*.rules "$kernel"/*.ko "$work/"
failed=0

# guest NAME FILTER [KERNEL_OPTION ...]
guest() {
  local name=$1 tests=${filter:-$2} started=$SECONDS log=$work/$1.log
  shift 2
  [ -z "$only" ] || [ "$only" = "$name" ] || return 0
  echo "== guest in $name time"
  TMPDIR=$memory timeout -k 5 "$seconds" "$kernel/linux" "mem=${megabytes}M" root=/dev/root rootfstype=hostfs \
    rootflags=/ ro "init=$work/init" "FILTER=$tests" con=null con0=fd:0,fd:1 quiet "uml_dir=$work/uml" "$@" \
    </dev/null 2>&1 | tr -d '\r' | tee "$log"
  local status=${PIPESTATUS[0]}
  if ! grep -qx 'JOB-RC 0' "$log"; then
    failed=1
    if [ "$status" -eq 124 ] || [ "$status" -eq 137 ]; then
      echo "the guest was ended after $seconds s"
    elif ! grep -q '^JOB-RC ' "$log"; then
      echo "the guest ended without a result"
    fi
  fi
  echo "== $((SECONDS - started)) s"
}

guest real '-*InVirtualTime*'
guest virtual '*InVirtualTime*:*Contract*:*DriveOver*' time-travel=inf-cpu
exit $failed
