#!/bin/bash
# registers_test.sh WITH_VCAN LIBRARIES PROBE - tests both ways in which user-mode-linux can set registers: with its own
# code, and with libwhole_registers.so preloaded. On a processor without AMX, the test imitates a host with the large
# state of AMX. Exit code 77: this is no x86 processor, and user-mode-linux is not there.
set -u
case $(uname -m) in x86_64 | i?86) ;; *) exit 77 ;; esac
with_vcan=$1 libraries=$2 probe=$3
export WITH_VCAN_LIBRARIES=$libraries
unset WITH_VCAN_REGISTERS
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

amx() { grep -qm1 amx_tile /proc/cpuinfo; }

# guest [OPTION...] - runs the probe `numbers` in a guest.
guest() { "$with_vcan" -m uml -t 1500 "$@" "$probe" numbers >"$folder/said" 2>&1; }

# expect WORDS WHAT - fails unless the last guest has printed WORDS.
expect() {
  if grep -q "$1" "$folder/said"; then echo "ok    $2"; return; fi
  echo "FAIL  $2"
  cat "$folder/said"
  failures=$((failures + 1))
}

guest -x auto; expect "numbers are right" "a guest calculates in the way that with-vcan chooses here"
guest -x whole; expect "numbers are right" "with -x whole, on this processor"
guest -x plain
if amx; then expect put_fp_registers "with -x plain it panics, as this processor has AMX"
else expect "numbers are right" "with -x plain, on this processor"; fi

# The following guests have the state of AMX. The library for the kernel is preloaded first, because it has to work with
# this state.
cat >"$folder/kernel" <<END
#!/bin/sh
LD_PRELOAD="\${LD_PRELOAD:+\$LD_PRELOAD:}$libraries/liblarge_registers.so" exec ${WITH_VCAN_KERNEL:-linux.uml} "\$@"
END
chmod 755 "$folder/kernel"
export WITH_VCAN_KERNEL=$folder/kernel
guest -x plain; expect put_fp_registers "with -x plain it panics on a host with 11 kB of registers"
WITH_VCAN_REGISTERS=whole guest; expect "numbers are right" "with WITH_VCAN_REGISTERS=whole it calculates there"
WITH_VCAN_LIBRARIES=$folder/none guest -x whole; expect "build the target whole_registers" "without the library it says what to build"
guest -x some; expect "is auto, whole or plain" "a wrong way is refused"
[ $failures -eq 0 ]
