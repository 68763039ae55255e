# What the other tools need before they can work. To be sourced by bash:
#   setup_packages        the compiler and libraries; installs those that are missing where it may, else says which and ends
#   setup_build PRESET    configures and builds (release or debug)
#   setup_python          numpy, matplotlib and h5py in build/venv; sets $python, fails with a message if they cannot be had
# All of them do nothing, quickly, when there is nothing to do.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
jobs=${BRISANCE_JOBS:-$(nproc 2>/dev/null || echo 2)}
python_modules="numpy matplotlib h5py"

say() { printf '== %s\n' "$*"; }
complain() { printf '%s\n' "$*" >&2; }

# ---- packages

# Each Debian package and a command that succeeds if what the build needs of it is there, however it came.
required_packages=(
  "gfortran|command -v gfortran"
  "libc6-dev|compiler_links"
  "make|command -v make"
  "cmake|cmake_is_new_enough"
  "pkg-config|command -v pkg-config"
  "libopenmpi-dev|command -v mpifort"
  "openmpi-bin|command -v mpirun"
  "libhdf5-openmpi-dev|has_parallel_hdf5"
  "libfftw3-dev|has_fftw"
  "python3|command -v python3"
  "python3-venv|find_python"
)

compiler_links() {
  [ -e /usr/include/stdio.h ] && return # the common case, without running anything
  command -v gcc && echo 'int main(void) { return 0; }' | gcc -x c - -o /dev/null
}
cmake_is_new_enough() {
  local version
  version=$(cmake --version | sed -n 's/^cmake version \([0-9]*\.[0-9]*\).*/\1/p')
  [ "${version%%.*}" -gt 3 ] || { [ "${version%%.*}" -eq 3 ] && [ "${version#*.}" -ge 21 ]; }
}
has_parallel_hdf5() { command -v h5pfc || { [ -n "${HDF5_ROOT:-}" ] && [ -d "$HDF5_ROOT" ]; }; }
has_fftw() { command -v pkg-config && pkg-config --exists fftw3; }
# A python3 that can make virtual environments: Debian's own may lack the module ensurepip.
find_python() {
  local candidate
  for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import venv, ensurepip, sys; assert sys.version_info >= (3, 8)'; then
      base_python=$candidate
      return 0
    fi
  done
  return 1
}

missing_packages() {
  local entry
  for entry in "${required_packages[@]}"; do
    eval "${entry#*|}" >/dev/null 2>&1 || printf '%s ' "${entry%%|*}"
  done
}

# Says how the packages would be installed here, as root or by sudo without a password; fails if it cannot be.
may_install() {
  become_root=()
  command -v apt-get >/dev/null || return 1
  [ "$(id -u)" -eq 0 ] && return 0
  become_root=(sudo -n)
  command -v sudo >/dev/null && sudo -n true 2>/dev/null
}

install_packages() { # install_packages NAME...
  say "installing: $*"
  # The lists may be absent or old, so they are fetched first; if that fails the install may still find what it needs.
  "${become_root[@]}" apt-get update -q >/dev/null 2>&1 </dev/null || true
  "${become_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "$@" </dev/null
}

setup_packages() {
  local missing
  read -ra missing < <(missing_packages; echo)
  [ ${#missing[@]} -eq 0 ] && return 0
  say "missing: ${missing[*]}"
  if ! may_install; then
    complain "error: these Debian packages are missing, and only root can install them: ${missing[*]}"
    complain "         apt-get update && apt-get install ${missing[*]}"
    complain "       (On another system: what they are called there, or the modules that hold them.)"
    exit 1
  fi
  if ! install_packages "${missing[@]}"; then
    complain "error: these packages are missing and could not be installed (no network?): ${missing[*]}"
    complain "         apt-get update && apt-get install ${missing[*]}"
    exit 1
  fi
  hash -r
  read -ra missing < <(missing_packages; echo)
  if [ ${#missing[@]} -gt 0 ]; then
    complain "error: installed, but still not found: ${missing[*]} (is another program of that name first in PATH?)"
    exit 1
  fi
}

# ---- the program

setup_build() { # setup_build PRESET
  local preset=$1 folder="$root/build/$1" log
  log=$folder/setup.log
  mkdir -p "$folder"
  # A folder that was copied or moved holds paths that no longer mean anything.
  if [ -f "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
    say "build/$preset belongs to another place, making it anew"
    rm -rf "$folder"
    mkdir -p "$folder"
  fi
  if [ ! -f "$folder/Makefile" ] && [ ! -f "$folder/build.ninja" ]; then
    say "configuring build/$preset"
    if ! (cd "$root" && cmake --preset "$preset") >"$log" 2>&1; then
      rm -f "$folder/CMakeCache.txt" # so that nothing wrongly found is kept
      complain "error: configuring failed:"
      grep -v -e '^-- ' "$log" | tail -n 40 >&2
      exit 1
    fi
  fi
  if ! (cd "$root" && cmake --build --preset "$preset" -j "$jobs" ${2:+--target "$2"}) >"$log" 2>&1; then
    complain "error: building failed (all of it is in ${log#"$root"/}):"
    { grep -i -B 8 -A 2 -e '^error' -e 'error:' "$log" || tail -n 20 "$log"; } | tail -n 60 >&2
    exit 1
  fi
  if grep -q 'Building Fortran' "$log"; then say "built build/$preset"; else say "build/$preset is up to date"; fi
}

# ---- Python

python_has_modules() { # python_has_modules PYTHON
  [ -x "$(command -v "$1")" ] && "$1" -c "import ${python_modules// /, }" >/dev/null 2>&1
}

# Debian's own modules in place of those of pip: a virtual environment of its python3 that sees them.
venv_of_debian_modules() {
  python_has_modules /usr/bin/python3 && /usr/bin/python3 -c 'import venv, ensurepip' 2>/dev/null || return 1
  rm -rf "$venv"
  /usr/bin/python3 -m venv --system-site-packages "$venv" >>"$log" 2>&1
}

setup_python() {
  local venv="$root/build/venv" log="$root/build/venv.log" debian_modules="python3-venv python3-numpy python3-matplotlib python3-h5py"
  python="$venv/bin/python"
  if [ -f "$venv/complete" ] && [ "$(cat "$venv/complete")" = "$venv $python_modules" ] && [ -x "$python" ]; then return 0; fi
  say "making build/venv ($python_modules)"
  mkdir -p "$root/build"
  rm -rf "$venv" "$log"
  if ! venv_of_debian_modules && ! { find_python >/dev/null 2>&1 && "$base_python" -m venv "$venv" >>"$log" 2>&1 &&
    "$python" -m pip install --disable-pip-version-check --retries 1 --quiet $python_modules >>"$log" 2>&1 </dev/null; }; then
    may_install && install_packages $debian_modules >>"$log" 2>&1 && venv_of_debian_modules
  fi
  if ! python_has_modules "$python"; then
    complain "error: pictures need the Python modules $python_modules, which pip could not install (see build/venv.log)."
    complain "       Without pip, root can install Debian's own: apt-get install $debian_modules"
    rm -rf "$venv"
    return 1
  fi
  echo "$venv $python_modules" >"$venv/complete" # with the place: a virtual environment cannot be moved
}

# ---- MPI

# Settings for Open MPI on one machine: quiet, and at ease in a container. Another MPI does not look at them.
setup_mpi() {
  export OMPI_MCA_btl_base_warn_component_unused=0 OMPI_MCA_btl_vader_single_copy_mechanism=none
  export GLIBC_TUNABLES=${GLIBC_TUNABLES:-glibc.malloc.hugetlb=1} # huge pages for large arrays (glibc 2.35)
  if ! command -v ssh >/dev/null && ! command -v rsh >/dev/null; then
    export OMPI_MCA_plm=${OMPI_MCA_plm:-isolated} # it would complain that there is no remote shell, which is not needed
  fi
  mpi_options=()
  if mpirun --version 2>/dev/null | grep -q 'Open MPI'; then
    mpi_options=(--quiet --bind-to none --oversubscribe)
    [ "$(id -u)" -eq 0 ] && mpi_options+=(--allow-run-as-root)
  fi
  return 0
}
