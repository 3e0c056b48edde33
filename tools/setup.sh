# shellcheck shell=bash
# Shared by ./run and ./test: installs what is missing, builds the program and the page, and says which step failed.
# Sourced, from the top of the tree; everything it makes goes below build/ and studio/.

logs=build/logs
mkdir -p "$logs"

say() { printf '%s\n' "$*"; }

fail() {
  printf 'topple: %s\n' "$*" >&2
  exit 1
}

# step NAME COMMAND...: runs a command with its output in a log of its own; on failure shows the log's end and where it is.
step() {
  local name=$1 log
  shift
  log=$logs/${name// /-}.log
  if ! "$@" >"$log" 2>&1 </dev/null; then
    tail -n 40 "$log" >&2
    fail "the step '$name' failed; all it said is in $log"
  fi
}

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

apt_install() {
  # An unreachable repository that Topple does not need is no reason to stop: the installation itself tells.
  as_root apt-get update || true
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"
}

installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# node_is_fit: whether the PATH has npm and a node as new as studio/package.json's "engines" asks for.
node_is_fit() {
  command -v node >/dev/null && command -v npm >/dev/null &&
    node -e '
      const wanted = require("./studio/package.json").engines.node.match(/\d+/g).map(Number);
      const found = process.versions.node.split(".").map(Number);
      const differs = wanted.findIndex((part, i) => part !== found[i]);
      process.exit(differs < 0 || found[differs] > wanted[differs] ? 0 : 1);'
}

# install_packages FILE...: the Debian packages named in the files, and node for the page, where they are missing.
install_packages() {
  command -v dpkg-query >/dev/null ||
    fail "this is not Debian: install the packages of $* by hand, then build with CMake as README.md says"
  local missing=() package
  while read -r package; do
    installed "$package" || missing+=("$package")
  done < <(cat "$@")
  node_is_fit || missing+=(nodejs npm)
  if [ ${#missing[@]} -gt 0 ]; then
    [ "$(id -u)" = 0 ] || command -v sudo >/dev/null ||
      fail "these Debian packages are missing, and there is neither root nor sudo to install them: ${missing[*]}"
    say "Installing ${missing[*]}"
    step "install packages" apt_install "${missing[@]}"
  fi
  node_is_fit || fail "the page needs node $(node_wanted), and Debian gave $(node --version 2>/dev/null || echo none)"
}

node_wanted() { sed -n 's/.*"node": *"\([^"]*\)".*/\1/p' studio/package.json; }

# configure PRESET [OPTION...]
configure() { step "configure $1" cmake --preset "$@"; }

# changed STAMP PATH...: whether anything in the paths differs from when the stamp was written; leaves the new stamp in $stamp_now.
changed() {
  local stamp=$1
  shift
  stamp_now=$(find "$@" -type f -print0 | LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum)
  [ "$(cat "$stamp" 2>/dev/null)" != "$stamp_now" ]
}

install_page_packages() {
  if [ ! -d studio/node_modules ] || changed studio/node_modules/.topple-stamp studio/package.json studio/package-lock.json; then
    say "Fetching the page's packages"
    changed studio/node_modules/.topple-stamp studio/package.json studio/package-lock.json || true
    step "fetch packages of the page" npm --prefix studio ci --no-audit --no-fund
    printf '%s\n' "$stamp_now" >studio/node_modules/.topple-stamp
  fi
}

# build_engine: the core chapters as WebAssembly, for the page. Needs the packages of tools/packages-engine.txt.
build_engine() {
  [ -f build/wasm/build.ninja ] || configure wasm
  step "build the page's engine" cmake --build build/wasm --target topple_engine
  mkdir -p studio/public
  cmp -s build/wasm/engine.wasm studio/public/engine.wasm || cp build/wasm/engine.wasm studio/public/engine.wasm
}

# build_engine_if_possible: without the engine the page still plays recordings, so that its lack is a sentence and no failure.
build_engine_if_possible() {
  if (install_packages tools/packages-engine.txt && say "Building the page's engine" && build_engine) 2>"$logs/engine.log"; then return; fi
  rm -f studio/public/engine.wasm
  say "The page comes without its engine, since clang 22 and the WASI packages of Debian cannot be had or used here (see $logs):"
  say "it plays recordings and compares them, but layouts are run by build/release/topple alone."
}

build_page() {
  install_page_packages
  local sources=(studio/package-lock.json studio/index.html studio/src studio/vite.config.ts studio/published.ts studio/tsconfig.json validation)
  [ ! -d studio/public ] || sources+=(studio/public)
  if [ ! -f studio/dist/index.html ] || changed build/studio.stamp "${sources[@]}"; then
    say "Building the page"
    changed build/studio.stamp "${sources[@]}" || true
    step "build the page" npm --prefix studio run build
    printf '%s\n' "$stamp_now" >build/studio.stamp
  fi
}
