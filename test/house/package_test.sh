#!/bin/sh
# package_test.sh FOLDER [BASE.tar] - installs the Debian packages in FOLDER (share/package.sh) into a new Debian 12, runs the demo,
# upgrades from an older version, removes and purges them, and checks that nothing is left. The test needs root and mmdebstrap, and
# downloads about 60 MB. BASE.tar is an existing Debian system (mmdebstrap --variant=apt bookworm BASE.tar).
set -eu
folder=$(cd "$1" && pwd)
sh "$(dirname "$0")/../../share/install_packages.sh" chroot
tmp=$(mktemp -d)
root=$tmp/root
end() {
  umount "$root/proc" 2>/dev/null || true
  rm -rf "$tmp"
}
trap end EXIT
failed=0
check() { # NAME COMMAND...
  name=$1
  shift
  if "$@" >"$tmp/log" 2>&1; then
    echo "ok    $name"
  else
    echo "FAIL  $name"
    sed 's/^/      /' "$tmp/log"
    failed=1
  fi
}
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
apt() { inside apt-get -qy -o Dpkg::Options::=--force-confold "$@"; }
# Lists the files of the system without the records of dpkg and apt. ldconfig rewrites its cache.
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./sys -o -path ./dev -o -path ./run -o -path ./tmp -o -path ./packages \
    -o -path ./var/cache -o -path ./var/log -o -path ./var/lib/apt -o -path ./var/lib/dpkg \) -prune -o -print | sort)
}

base=${2:-$tmp/base.tar}
[ -e "$base" ] || mmdebstrap --variant=apt bookworm "$base" 2>"$tmp/log" || { cat "$tmp/log" >&2; exit 1; }
mkdir "$root"
tar --extract --file "$base" --directory "$root"
mount -t proc proc "$root/proc"
cp /etc/resolv.conf "$root/etc"
apt update >"$tmp/log" 2>&1 || { cat "$tmp/log" >&2; exit 1; }
mkdir "$root/packages"
cp "$folder"/*.deb "$root/packages"
# An older version has the same files and another version number.
for package in takt libtakt-dev takt-doc; do
  dpkg-deb -R "$folder/$package"_*.deb "$tmp/old"
  sed -i 's/^Version: .*/Version: 0.0.1/; s/takt (= [^)]*)/takt (= 0.0.1)/' "$tmp/old/DEBIAN/control"
  dpkg-deb --root-owner-group -b "$tmp/old" "$root/packages/old-$package.deb" >/dev/null
  rm -rf "$tmp/old"
done
files >"$tmp/before"

check "the packages install on a new Debian 12" apt install --no-install-recommends /packages/old-takt.deb /packages/old-takt-doc.deb
[ $failed -eq 0 ] || exit 1
started=$(date +%s)
check "takt demo moves its axes" inside takt demo --for 5s
echo "      in $(($(date +%s) - started)) s"
cp "$tmp/log" "$tmp/demo"
check "it says so" grep -q 'The axes followed' "$tmp/demo"
check "the user can name a machine" inside sh -ec 'cp /usr/share/doc/takt/examples/demo/two_axes.yaml /etc/takt/my.yaml
  sed -i "s|\.\./eds|/usr/share/takt/eds|; s|^bus:.*|bus: {name: my, interface: can0}|" /etc/takt/my.yaml && taktd /etc/takt/my.yaml --check'
for file in lib/systemd/system/taktd@.service lib/systemd/network/60-takt-can.link usr/share/man/man1/takt-plan.1.gz usr/share/man/man8/taktd.8.gz \
  usr/share/bash-completion/completions/takt usr/share/zsh/vendor-completions/_takt usr/share/doc/takt/index.md usr/share/doc/takt/copyright; do
  check "there is $file" test -e "$root/$file"
done

# A file that the user has changed stays as it is.
echo '# mine' >>"$root/etc/security/limits.d/takt.conf"
check "the packages are upgraded" apt install --no-install-recommends $(cd "$root/packages" && for file in takt_*.deb takt-doc_*.deb; do echo "/packages/$file"; done)
check "the version is the new one" inside sh -c '! dpkg-query -W takt | grep -q 0.0.1'
check "a changed conffile is kept" grep -q '^# mine' "$root/etc/security/limits.d/takt.conf"
check "the demo runs after the upgrade" inside takt demo --for 5s

check "takt is removed" apt remove takt takt-doc
check "its conffile stays until it is purged" test -e "$root/etc/security/limits.d/takt.conf"
check "network files of the user stay" test -e "$root/etc/takt/my.yaml"
rm "$root/etc/takt/my.yaml"
mkdir -p "$root/var/lib/takt/my"
check "takt is purged" apt purge takt takt-doc
check "what was installed for it goes as well" apt autoremove --purge
files >"$tmp/after"
check "nothing is left" diff "$tmp/before" "$tmp/after"
exit $failed
