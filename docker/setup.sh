# shellcheck shell=bash
# Sourced by campaigns/run and tests/run: what turns a bare Debian 12 or 13 into one with a built dispersa.
# Everything here writes to stderr only, because stdout belongs to the program that runs afterwards.

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_directory="$repository/build/release"
# What one checkout has compiled serves every other one on the machine.
export CCACHE_BASEDIR="$repository" CCACHE_NOHASHDIR=1

say() { printf 'dispersa: %s\n' "$*" >&2; }

is_installed() { [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

# What the given lists name and the machine lacks, one a line: a package, or `one|other` where systems name it differently.
missing_packages() {
  local line package
  sed --regexp-extended 's/#.*//; s/[[:space:]]+//g; /^$/d' "$@" | while read -r line; do
    for package in ${line//|/ }; do
      is_installed "$package" && continue 2
    done
    printf '%s\n' "$line"
  done
}

as_root() {
  if [[ $(id --user) == 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    say "installing packages needs root or sudo"
    return 1
  fi
}

apt() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 "$@" </dev/null; }

# install_packages LIST...: installs what the lists name and the machine lacks. A failure shows apt's errors
# and names each package that apt refuses by itself, with the reason.
install_packages() {
  local missing package log reason
  if ! command -v dpkg-query >/dev/null; then
    say "not a Debian system: taking the packages of docker/packages.txt for granted"
    return 0
  fi
  mapfile -t missing < <(missing_packages "$@")
  [[ ${#missing[@]} == 0 ]] && return 0

  say "installing ${missing[*]}"
  log=$(mktemp)
  if { apt update; apt satisfy --yes --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    rm -f "$log"
    return 0
  fi
  grep '^[EW]:' "$log" >&2 || tail -n 20 "$log" >&2
  rm -f "$log"
  mapfile -t missing < <(missing_packages "$@")
  say "not installed: ${missing[*]}"
  for package in "${missing[@]}"; do
    reason=$(apt satisfy --simulate "$package" 2>&1 | grep -m 1 -o 'Depends: .*') && say "could not install $package: $reason"
  done
  return 1
}

# quietly COMMAND...: runs it, and shows what it printed only if it fails.
quietly() {
  local log
  log=$(mktemp)
  "$@" >"$log" 2>&1 || { cat "$log" >&2; rm -f "$log"; say "failed: $*"; return 1; }
  rm -f "$log"
}

# build_dispersa TARGET [-D...]: configures build/release if options are given, and builds the target in
# it. Silent when there is nothing to do; two calls at the same time queue up.
build_dispersa() {
  local target=$1
  shift
  mkdir -p "$build_directory" && (
    flock 9 && cd "$repository" || exit 1
    [[ $# == 0 ]] || quietly cmake --preset release "$@" || exit 1
    [[ $(ninja -C "$build_directory" -n "$target" 2>&1) == *'no work to do.'* ]] && exit 0
    say "building (the first time takes some minutes)"
    if [[ -t 2 ]]; then
      cmake --build "$build_directory" --target "$target" >&2
    else
      quietly cmake --build "$build_directory" --target "$target"
    fi
  ) 9>"$repository/build/.lock"
}
