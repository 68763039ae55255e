# The target brisance_flags carries the compiler options of each build type, for the program and its tests alike;
# brisance_warnings those of the program only (tests compare reals for equality, and mean it).
#
# Deliberately absent: -ffast-math and -fno-signed-zeros (they change answers and break tests for not-finite numbers).
# -ffp-contract=off: a fused multiply-add rounds differently wherever the compiler happens to choose it, and the same run must give
# the same bits whichever loop (vector body or remainder) a cell falls in.
add_library(brisance_flags INTERFACE)
add_library(brisance_warnings INTERFACE)

if(CMAKE_Fortran_COMPILER_ID STREQUAL "GNU")
  set(release_flags -O3 -fopenmp-simd -fno-trapping-math -ffp-contract=off)
  if(BRISANCE_NATIVE)
    list(APPEND release_flags -march=native)
  endif()
  # array-temps is left out of the checks: it prints a warning at run time for what is correct code.
  set(debug_flags -O0 -g -fcheck=all,no-array-temps -fbacktrace -ffpe-trap=invalid,zero,overflow -ffp-contract=off)
  # CMake's own defaults (-O3, -g) would only repeat what stands here.
  set(CMAKE_Fortran_FLAGS_RELEASE "")
  set(CMAKE_Fortran_FLAGS_DEBUG "")
  target_compile_options(brisance_flags INTERFACE
    "$<$<CONFIG:Release>:${release_flags}>"
    "$<$<CONFIG:Debug>:${debug_flags}>"
    "$<$<CONFIG:RelWithDebInfo>:${release_flags};-g>")
  target_compile_options(brisance_warnings INTERFACE "$<$<CONFIG:Debug>:-Wall;-Wextra>")
elseif(NOT CMAKE_Fortran_FLAGS)
  message(WARNING "Options are known for gfortran only; give those of ${CMAKE_Fortran_COMPILER_ID} in CMAKE_Fortran_FLAGS "
    "(no contraction to fused multiply-add, no fast-math).")
endif()
