# What shell tests begin with, to be sourced with the name of a folder: that folder, empty, to work in; source_folder, the project;
# and checks that are counted in passed and failed.
source_folder=${BRISANCE_SOURCE:-$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)}
work=$PWD/$1
passed=0 failed=0
rm -rf "$work" && mkdir -p "$work" && cd "$work" || exit 1

check() { # check NAME COMMAND...: the command must succeed
  local name=$1
  shift
  if "$@" >log 2>&1; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "  FAILED: $name"; cat log; fi
}
close() { # close VALUE LOW HIGH
  awk -v v="$1" -v a="$2" -v b="$3" 'BEGIN { exit !(v > a && v < b) }'
}
