#!/usr/bin/env bash
# Collects what a 64-bit ARM machine boots with, once for every version: Debian's own kernel, the modules that it needs
# to see the host's files, and built for it gpio-sim, which Debian leaves out, and the modules beside this script. Needs
# no root; tools/setup aarch64 gives the compiler.
# The last line it prints is the folder with `vmlinuz`, `modules/` and `busybox`.
# Usage: tests/kernel/aarch64_build.sh
set -euo pipefail
export PATH=$PATH:/usr/sbin # depmod
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/kernel/packages.sh
source "$here/packages.sh"

image=$(meant_by linux-image-arm64:arm64) # linux-image-6.1.0-56-arm64:arm64
image=${image%:arm64}
version=$(candidate "${image:-none}:arm64")
key=$({ aarch64-linux-gnu-gcc-12 --version && cat "$here"/{modules/*,aarch64_build.sh}; } | sha256sum | cut -c 1-16)
if [ -z "$version" ]; then kept "arm64-$key"; fi
folder=$cache/$version-arm64-$key
begin arm64 "$folder"
release=${image#linux-image-}         # 6.1.0-56-arm64
series=$(cut -d. -f1,2 <<<"$version") # 6.1
fetch "$image:arm64=$version" "linux-headers-$release:arm64=$version" "linux-headers-${release%-arm64}-common=$version" \
  "linux-kbuild-$series=$version" "linux-source-$series=$version" busybox-static:arm64

say "unpacking"
dpkg-deb --fsys-tarfile "$image"_*.deb |
  tar -x --wildcards './boot/vmlinuz*' '*/kernel/drivers/virtio/*' '*/kernel/fs/9p/*' '*/kernel/net/9p/*' \
    '*/kernel/fs/netfs/*' '*/kernel/fs/fscache/*' '*/kernel/fs/configfs/*' '*/kernel/drivers/i2c/i2c-dev.ko' \
    '*/modules.builtin*' '*/modules.order'
for deb in linux-headers-*.deb linux-kbuild-*.deb busybox-static_*.deb; do dpkg-deb -x "$deb" .; done
mkdir own
dpkg-deb --fsys-tarfile linux-source-*.deb | tar -xO --wildcards '*/linux-source-*.tar.xz' | xz -dc -T0 |
  tar -x -C own --transform='s,.*/,,' --wildcards '*/kernel/irq/irq_sim.c' '*/drivers/gpio/gpio-sim.c' \
    '*/drivers/gpio/gpiolib.h'

say "building"
# In the kernel irq_sim is never a module, so it uses a function that modules are not given.
sed -i 's/handle_simple_irq(irq_to_desc(irqnum));/generic_handle_irq(irqnum);/
  s,#include <linux/slab.h>,&\n#include <linux/module.h>,
  $a MODULE_LICENSE("GPL");' own/irq_sim.c
cp "$here"/modules/* own/
echo 'obj-m += irq_sim.o gpio-sim.o' >>own/Kbuild
headers=$work/usr/src/linux-headers-$release
sed -i "s,/usr/src,$work/usr/src," "$headers/Makefile"
make -s -C "$headers" M="$work/own" DEB_BUILD_ARCH=amd64 DEB_HOST_ARCH=arm64 DEB_HOST_GNU_TYPE=aarch64-linux-gnu \
  -j "$(nproc)" modules >&2

mkdir -p result/modules "lib/modules/$release/own"
cp own/*.ko "lib/modules/$release/own/"
depmod -b "$work" "$release"
# In the order in which insmod takes them.
for module in virtio_pci 9pnet_virtio 9p configfs i2c-dev gpio-sim i2c_sim pwm_sim; do
  modprobe -d "$work" -S "$release" --show-depends "$module"
done | sed -n 's/^insmod \([^ ]*\).*/\1/p' | awk '!seen[$0]++' >needed
while read -r path; do
  cp "$path" result/modules/
  basename "$path" >>result/modules/order
done <needed
cp boot/vmlinuz-* result/vmlinuz
cp bin/busybox result/busybox
mv result "$folder"
say "built $folder"
echo "$folder"
