# What the cases of the emulated board share: its kernel, its file system, and how it is booted.
# Sourced with root, build (glint_board, sysroot), host (glint, glint_board_frames) and work set.
# The clock counts instructions and nothing in the machine is left to chance: a run depends neither
# on the host's load nor on when it is made.

machine=$root/tests/hil/arm64
sysroot=$build/sysroot
modules=(net/can/can.ko net/can/can-raw.ko drivers/net/can/dev/can-dev.ko
  drivers/net/can/sja1000/sja1000.ko drivers/net/can/sja1000/kvaser_pci.ko net/sched/sch_tbf.ko
  drivers/virtio/virtio_pci_modern_dev.ko drivers/virtio/virtio_pci_legacy_dev.ko
  drivers/virtio/virtio_pci.ko drivers/block/virtio_blk.ko crypto/crc32c_generic.ko lib/crc16.ko
  fs/mbcache.ko fs/jbd2/jbd2.ko fs/ext4/ext4.ko)

skip() { echo "skipped: $*"; exit 77; }

check_tools() {  # programs of the host that this case needs
  local tool program
  for tool in qemu-system-aarch64 qemu-aarch64-static aarch64-linux-gnu-gcc cpio dpkg-deb apt-get; do
    command -v $tool > /dev/null || skip "$tool is not installed"
  done
  for program in "$build/glint_board" "${@/#/$host/}"; do
    [ -x "$program" ] || { echo "$program is not built"; exit 1; }
  done
}

# The kernel that Debian's meta package names today; only what the test needs is kept of it.
fetch_kernel() {
  local package folder
  ! cmp -s <(printf '%s\n' "${modules[@]}") "$work/kernel/modules" || return 0
  board_apt() { "$root/platform/apps/board/board_apt" "$sysroot.apt" "$@"; }
  package=$(board_apt apt-cache depends linux-image-rt-arm64 2> /dev/null |
    awk '/Depends: linux-image/ {print $2; exit}')
  [ -n "$package" ] || return 1
  folder=$(mktemp -d "$work/fetch.XXXXXX")
  if (cd "$folder" && board_apt apt-get download -qq "$package" > /dev/null 2>&1) &&
    dpkg-deb --fsys-tarfile "$folder"/*.deb | tar -x -C "$folder" --wildcards './boot/vmlinuz-*' \
      "${modules[@]/#/./lib/modules/*/kernel/}"; then
    rm "$folder"/*.deb
    printf '%s\n' "${modules[@]}" > "$folder/modules"
    rm -rf "$work/kernel"
    mv "$folder" "$work/kernel"
  else
    rm -rf "$folder"
    return 1
  fi
}

add_program() {  # with the libraries that it names
  local library
  cp -L "$1" "$image/usr/bin/"
  qemu-aarch64-static -L "$sysroot" -E LD_LIBRARY_PATH=/lib:/usr/lib/aarch64-linux-gnu \
    -E LD_TRACE_LOADED_OBJECTS=1 "$1" | grep -oE '/[^ ]+' | while read -r library; do
      [ -e "$sysroot$library" ] && library=$sysroot$library
      cp -Ln "$library" "$image/lib/"
    done
}

# A shell, ip, Glint, and what a guest says with semihosting; `guest` is the first program.
make_image() {  # guest
  local module program
  mkdir -p "$image"/{bin,proc,sys,dev,tmp,lib,modules,usr/bin}
  cp -L "$sysroot/bin/busybox" "$image/bin/busybox"
  ln -s busybox "$image/bin/sh"
  cp "$1" "$image/init"
  cp "$machine/guest_setup" "$image/setup"
  add_program "$build/glint_board"
  add_program "$sysroot/bin/ip"
  aarch64-linux-gnu-strip "$image/usr/bin/glint_board"
  for program in guest_exit guest_give; do
    aarch64-linux-gnu-gcc --sysroot="$sysroot" -O2 -static "$machine/$program.c" \
      -o "$image/usr/bin/$program"
  done
  for module in "${modules[@]}"; do
    cp "$work"/kernel/lib/modules/*/kernel/"$module" "$image/modules/"
    basename "$module" >> "$image/modules/order"
  done
}
pack_image() { (cd "$image" && find . -print0 | cpio --null -o -H newc --quiet) > "$1"; }

# What the guest gives is written into `folder`; its console goes to standard output.
boot() {  # folder, packed image, further devices
  cd "$1"
  exec timeout 7200 qemu-system-aarch64 -M virt,dtb-randomness=off -cpu cortex-a72 -m 1024 \
    -accel tcg -icount shift=1,sleep=off -rtc base=2026-01-01,clock=vm \
    -nodefaults -no-user-config -nographic -no-reboot -serial stdio \
    -semihosting-config enable=on,userspace=on,target=native \
    -kernel "$work"/kernel/boot/vmlinuz-* -initrd "$2" \
    -append "console=ttyAMA0 panic=-1 quiet nokaslr" \
    -object can-bus,id=bus0 -device kvaser_pci,canbus=bus0 -device kvaser_pci,canbus=bus0 \
    "${@:3}" < /dev/null 2>&1
}

# A plan for this cell on one core, and what may be said of it: FOLDER/plan.toml, check.json.
compute_bound() {  # cell, folder
  local board=$root/schedules/boards/cortex-a72-emulated.toml
  "$host/glint" budget schedule --board "$board" --cell "$1" --cores 1 --out "$2/plan.toml" \
    > "$2/check.log" &&
    "$host/glint" budget check --board "$board" --cell "$1" --plan "$2/plan.toml" \
      --json "$2/check.json" >> "$2/check.log" ||
    { tail -30 "$2/check.log"; echo "no bound that holds for ${board#"$root/"}"; exit 1; }
}
