#!/bin/sh
# Installs the Debian packages that building, testing and the demo need; with the argument "check" also those of `make check`, with
# "bench" the solvers that the fit is compared with. Says what is missing where it may not install.
set -eu

packages="
    build-essential ccache cmake ninja-build pkg-config
    libopencv-dev libopencv-contrib-dev libopenimageio-dev libexif-dev liblcms2-dev libpng-dev libhdf5-dev libzstd-dev zlib1g-dev libjansson-dev libcairo2-dev
    libceres-dev liblapacke-dev libembree-dev libglfw3-dev libx11-dev libimgui-dev libstb-dev fonts-roboto-unhinted libepoxy-dev libegl-dev libgl-dev libgles2 libgl1-mesa-dri
    libhidapi-dev libconfuse-dev libgphoto2-dev libcmocka-dev umockdev libumockdev-dev python3 python3-h5py python3-mpmath python3-numpy xvfb xauth xdotool imagemagick poppler-utils librsvg2-bin help2man
"
case ${1-} in
check) packages="$packages clang-format clang-tidy gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user" ;;
bench) packages="$packages libcminpack-dev" ;;
esac

missing=""
for package in $packages; do
    status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
    [ "$status" = "install ok installed" ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

command="apt-get install -y --no-install-recommends$missing"
if ! command -v apt-get >/dev/null 2>&1; then
    echo "This is no Debian system. Install what these Debian packages hold, then run again:$missing" >&2
    exit 3
fi
if [ "$(id -u)" = 0 ]; then
    elevate=""
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
    elevate="sudo"
else
    echo "Packages are missing and may not be installed from this account. Run as root:" >&2
    echo "    $command" >&2
    exit 3
fi

echo "Installing:$missing"
$elevate apt-get update -q >/dev/null
export DEBIAN_FRONTEND=noninteractive
# shellcheck disable=SC2086
$elevate apt-get install -y -q --no-install-recommends $missing >/dev/null
