#!/usr/bin/env bash
# The first process of the guest that tests/kernel/run.sh boots: mounts what a Debian system has, loads the modules,
# starts udev with the project's rules, runs the tests and stops the machine. Beside it in its folder: program, *.ko,
# rules; FILTER comes from the kernel's command line. The root is the host's, read-only: whatever is written is in
# memory.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/run TMPDIR=/run
here=$(dirname "$0")
export FORAGER_KERNEL_GUEST=$here # whose modules tests may load

mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs dev /dev
mkdir -p /dev/pts /dev/shm
mount -t devpts devpts /dev/pts
mount -t tmpfs shm /dev/shm
mount -t tmpfs run /run
mount -t configfs configfs /sys/kernel/config

# The groups of the rules, whatever the host has.
number=60000
for group in gpio i2c dialout plugdev input; do
  getent group "$group" >/dev/null || echo "$group:x:$((++number)):"
done | cat /etc/group - >/run/group
mount --bind /run/group /etc/group
mkdir -p /run/udev/rules.d
cp "$here"/*.rules /run/udev/rules.d/
# Their example of a reader that plays a keyboard, as the owner of such a reader fills it in.
sed -n '/FFFF:FFFF/s/^#//; s/FFFF:FFFF/1209:0004/p' "$here"/*.rules >/run/udev/rules.d/99-keyboard.rules
/lib/systemd/systemd-udevd --daemon 2>/dev/null

insmod "$here/i2c-stub.ko" chip_addr=0x20
for module in i2c_sim pwm_sim; do insmod "$here/$module.ko"; done
udevadm trigger --action=add --subsystem-match=i2c-dev --subsystem-match=misc
udevadm settle --timeout=20

"$here/program" --gtest_color=no --gtest_filter="$FILTER"
echo "JOB-RC $?"
# reboot(RB_POWER_OFF): a system without an init has no command for it, but Debian is never without this.
perl -e 'syscall(169, 0xfee1dead, 672274793, 0x4321fedc, 0)'
