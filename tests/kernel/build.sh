#!/usr/bin/env bash
# Builds a User-Mode Linux kernel from Debian's linux-source and the modules beside it, once for every version of the
# source, configuration and compiler. Needs no root, but for apt-get update when the package lists are too old.
# The last line it prints is the folder with the kernel, `linux`, and its modules, `*.ko`.
# Usage: tests/kernel/build.sh
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/kernel/packages.sh
source "$here/packages.sh"

package=$(meant_by linux-source)
version=$(candidate "${package:-none}")
key=$({ gcc --version && cat "$here"/{uml.config,*.patch,modules/*,build.sh}; } | sha256sum | cut -c 1-16)
if [ -z "$version" ]; then kept "um-$key"; fi
folder=$cache/$version-um-$key
begin um "$folder"
fetch "$package=$version"

# Of what is never built only the Makefile and Kconfig files are needed.
say "unpacking"
dpkg-deb --fsys-tarfile "$package"_*.deb | tar -xO --wildcards '*/linux-source-*.tar.xz' | xz -dc -T0 |
  tar -x --strip-components=1 --one-top-level=source \
    --exclude='*/drivers/gpu/drm/*/*.[ch]' --exclude='*/drivers/net/*/*.[ch]' --exclude='*/drivers/media/*.[ch]' \
    --exclude='*/drivers/staging/*.[ch]' --exclude='*/sound/*.[ch]' --exclude='*/arch/[!ux]*/*.[chS]' \
    --exclude='*/arch/*/boot/dts' --exclude='*/Documentation/*.rst' --exclude='*/tools/testing'
for patch in "$here"/*.patch; do patch -s -p1 -d source <"$patch" >&2; done

# What costs is the build, not the guest: little optimisation saves a fifth, and ccache would cost a third.
build() { make -s -C source ARCH=um O="$work/build" KCFLAGS=-O1 -j "$(nproc)" "$@" >&2; }

say "building"
build KCONFIG_ALLCONFIG="$here/uml.config" allnoconfig
dropped=$(grep '^CONFIG' "$here/uml.config" | grep -vxFf build/.config || true)
if [ -n "$dropped" ]; then
  say "this kernel cannot have, or names otherwise:"
  echo "$dropped" >&2
  exit 1
fi
build linux modules
cp -r "$here/modules" own
build M="$work/own" modules

mkdir result
cp build/linux result/
find build own -name '*.ko' -exec cp {} result/ \;
mv result "$folder"
say "built $folder"
echo "$folder"
