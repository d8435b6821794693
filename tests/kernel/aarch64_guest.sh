#!/bin/busybox sh
# shellcheck shell=dash
# The first process of the 64-bit ARM guest that tests/kernel/aarch64_run.sh boots: sees the host's files, read-only,
# under /h, and runs `job` with the host's libraries of this architecture.
export PATH=/bin LD_LIBRARY_PATH=/h/usr/lib/aarch64-linux-gnu FORAGER_KERNEL_GUEST=1 TMPDIR=/tmp HOME=/tmp
/bin/busybox --install -s /bin
mkdir -p /dev /proc /sys /tmp /h /lib
mount -t devtmpfs dev /dev
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t tmpfs tmp /tmp
while read -r module; do insmod "/modules/$module"; done </modules/order
mount -t configfs configfs /sys/kernel/config
mount -t 9p -o ro,trans=virtio,version=9p2000.L,cache=loose,msize=262144 host /h
ln -s /h/usr/lib/aarch64-linux-gnu/ld-linux-aarch64.so.1 /lib/ld-linux-aarch64.so.1
sh /job
echo "JOB-RC $?"
poweroff -f
