# shellcheck shell=bash
# What the builders of kernels share: Debian's packages as files, unpacked beside the system and not into it. Sourced.

scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cache=${XDG_CACHE_HOME:-${HOME:-/tmp}/.cache}/forager/kernel

say() { echo "kernel: $*" >&2; }

# The newest version apt knows of a package; empty: it knows none.
candidate() { apt-cache policy "$1" 2>/dev/null | sed -n 's/^ *Candidate: //p' | sed '/^(none)$/d; q' || true; }

# The package that a meta-package stands for: "linux-source" is "linux-source-6.1".
meant_by() { apt-cache depends "$1" 2>/dev/null | sed -n 's/.*Depends: \([^ ]*\)$/\1/p' | sed q || true; }

refresh_lists() {
  if [ "$(id -u)" -eq 0 ]; then
    apt-get -q update >&2
  else
    sudo -n apt-get -q update >&2
  fi
}

download() { apt-get -q -o APT::Sandbox::User="$(id -un)" download "$@" >&2; }

# again: starts the script anew with new package lists; returns if it has done so before or cannot get them.
again() {
  if [ -n "${FORAGER_LISTS_ARE_NEW:-}" ] || ! refresh_lists; then return; fi
  cd "$scripts" || return
  rm -rf "${work:-}"
  FORAGER_LISTS_ARE_NEW=1 exec "$scripts/$(basename "$0")"
}

# fetch PACKAGE=VERSION ...: the .deb files, into this folder, which is the script's $work. With lists that are too old
# the script starts again with new ones.
fetch() {
  say "fetching $*"
  download "$@" && return
  again
  say "cannot fetch them: run apt-get update, and try again"
  exit 3
}

# begin KIND FOLDER: waits for another build of the kind. If that has made the folder the script ends with it; else it
# goes on in an empty folder, $work.
begin() {
  mkdir -p "$cache"
  exec 9>"$cache/$1.lock"
  flock 9
  if [ -d "$2" ]; then
    echo "$2"
    exit 0
  fi
  work=$cache/$1-work
  rm -rf "$work"
  trap 'rm -rf "$work"' EXIT
  mkdir "$work"
  cd "$work" || exit 1
}

# kept KEY: without package lists what was built before will do. Ends the script.
kept() {
  local folder
  mkdir -p "$cache"
  folder=$(find "$cache" -maxdepth 1 -name "*-$1" | sort -V | tail -n 1)
  if [ -z "$folder" ]; then
    again
    say "apt knows no kernel: run apt-get update"
    exit 3
  fi
  echo "$folder"
  exit 0
}
