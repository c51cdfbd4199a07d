# Sourced by tests/hil/run and tests/hil/controller/run, with root set: the controller's decoder for a
# Cortex-M3, and its decisions over a packed log beside this machine's.

decoder=$root/platform/sinks/can/controller

have_m3() { command -v arm-none-eabi-gcc > /dev/null && command -v qemu-system-arm > /dev/null; }

build_m3() {  # folder of m3.elf
  local flags=(-mcpu=cortex-m3 -mthumb -O2 -ffreestanding -Wall -Wextra -Werror) undefined
  (
    cd "$1"
    # -ffreestanding: no library. What remains undefined would be one.
    arm-none-eabi-gcc "${flags[@]}" -std=c99 -c "$decoder/glint_decode.c" "$decoder/glint_follow.c"
    undefined=$(arm-none-eabi-nm -u glint_decode.o glint_follow.o |
      awk '/ U / && !/glint_|__aeabi_(u?ldivmod|u?idivmod|u?idiv|l?mul|llsl|llsr|lasr)$/')
    [ -z "$undefined" ] || { echo "the decoder needs a library: $undefined"; exit 1; }
    arm-none-eabi-gcc "${flags[@]}" -std=gnu99 -nostdlib -T "$root/tests/hil/controller/mps2.ld" \
      "$root/tests/hil/controller/follow_log_m3.c" "$root/tests/hil/controller/follow_log.c" \
      glint_decode.o glint_follow.o -lgcc -o m3.elf
    arm-none-eabi-size glint_decode.o glint_follow.o
  )
}

# NAME.bin to NAME.host and NAME.m3. Returns 1, with the first differences, unless they are equal.
decide() {  # name, follow_log, m3.elf or empty: on this machine alone
  "$2" "$1.bin" > "$1.host"
  [ -n "$3" ] || return 0
  timeout 300 qemu-system-arm -M mps2-an385 -display none -monitor none -serial "file:$1.m3" \
    -semihosting -kernel "$3" -device loader,file="$1.bin",addr=0x21000000
  cmp "$1.host" "$1.m3" || { diff "$1.host" "$1.m3" | head -5; return 1; }
}
