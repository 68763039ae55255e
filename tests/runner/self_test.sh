#!/usr/bin/env bash
# Checks the stand-in for pFUnit: failing_sample must fail where it should, and the translator must refuse what it does not know.
#   self_test.sh FAILING_SAMPLE TRANSLATOR PYTHON WORK_FOLDER
set -u
sample=$1 translator=$2 python=$3 work=$4
source_file=$(dirname "$0")/failing_sample.pf
passed=0 failed=0
mkdir -p "$work"

check() { # check NAME COMMAND...: the command must succeed
  local name=$1
  shift
  if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "  FAILED: $name"; fi
}

has() { grep -qF -- "$1" <<<"$output"; }
lacks() { ! has "$1"; }

output=$("$sample" 2>&1)
status=$?
sed "s/^/  | /" <<<"$output"
check 'the sample exits with status 1' [ $status -eq 1 ]
check 'the counts are right' has 'failing_sample: 2 passed, 12 failed'
check 'a test stops at its first failure' lacks 'must not be reached'
expected=$(awk '/! fails on the next line$/ { print NR + 1 }' "$source_file")
reported=$(sed -n 's/.*FAILED at .*failing_sample\.pf:\([0-9]*\) in .*/\1/p' <<<"$output" | sort -n)
check 'the lines are right' [ "$expected" = "$reported" ]
check 'the message is printed' has 'the message'
check 'values are printed' has 'expected 3, got 4'
check 'the test is named' has 'in integer_differs:'
check 'the element is printed' has 'got 2.5000000000000000E+000 at element 2 (2 elements are wrong)'
check 'sizes are compared' has 'expected 2 elements, got 3'

refuses() { # refuses EXPECTED_MESSAGE: the translator fails with it on what stands on standard input
  cat >"$work/bad.pf"
  output=$("$python" "$translator" "$work/bad.pf" "$work/module.f90" "$work/main.f90" 2>&1)
  [ $? -ne 0 ] && has "$1"
}

check 'an unknown directive is refused' refuses 'bad.pf:3: @assertNonsense is not known' <<'END'
module bad
contains
  @assertNonsense(1)
end module bad
END
check 'a file without tests is refused' refuses 'there is no @test' <<'END'
module bad
end module bad
END
check 'a broken assertion is refused' refuses 'bad.pf:5: @assertTrue needs its arguments' <<'END'
module bad
contains
  @test
  subroutine a()
    @assertTrue(1 < 2, &
      message='two lines')
  end subroutine a
end module bad
END
check 'a comment behind an assertion is refused, as pFUnit does' refuses 'bad.pf:5: @assertTrue needs its arguments' <<'END'
module bad
contains
  @test
  subroutine a()
    @assertTrue(1 < 2) ! so it is
  end subroutine a
end module bad
END
check 'a test with arguments is refused' refuses 'bad.pf:4: the test a has arguments' <<'END'
module bad
contains
  @test
  subroutine a(n)
  end subroutine a
end module bad
END
check 'a stray @test is refused' refuses 'bad.pf:3: @test is not followed by a subroutine' <<'END'
module bad
contains
  @test
  integer function a()
  end function a
end module bad
END

echo "self_test: $passed passed, $failed failed"
[ $failed -eq 0 ]
