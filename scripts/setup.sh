#!/usr/bin/env bash
# Installs what tumble needs on Debian 12, as root or with sudo. Only what is missing: it can be run again at no cost.
#   scripts/setup.sh          to build and run
#   scripts/setup.sh test     also what the tests need
set -euo pipefail

packages=(g++ cmake ninja-build pkg-config
  libeigen3-dev libtbb-dev libhdf5-dev libosmesa6-dev libfreetype-dev fonts-dejavu-core libpng-dev
  libcairo2-dev fonts-liberation2
  libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev libopencv-videoio-dev
  libavcodec-dev libavformat-dev libavutil-dev
  libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libfmt-dev libnlopt-dev libxsimd-dev libdnnl-dev)
if [ "${1:-}" = test ]; then
  packages+=(libgtest-dev libgmock-dev clang-format chromium chromium-driver curl jq)
elif [ -n "${1:-}" ]; then
  echo "scripts/setup.sh: \"$1\" is unknown; give nothing, or test" >&2
  exit 2
fi

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "scripts/setup.sh: needs root to install: ${missing[*]}; run it as root, or install sudo" >&2
    exit 1
  }
  as_root=(sudo)
fi
echo "installing: ${missing[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
