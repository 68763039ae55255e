!> &heterogeneity (repeated): a random field on the strength, and the stiffness, of a body or a material.
module deck_heterogeneity
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_length
  implicit none
  private
  public :: heterogeneity_keys

  type, public :: heterogeneity_group
    character(word_length) :: body = '' !< empty: every body of the material
    character(word_length) :: material = '' !< empty: the body's own
    real(wp) :: coefficient_of_variation = unset !< of the strength
    real(wp) :: correlation_length(3) = unset !< in x, y, z; the first for those that are not given
    character(word_length) :: correlation = 'gaussian'
    character(word_length) :: distribution = 'lognormal'
    integer :: seed = 1
    real(wp) :: stiffness_exponent = 0 !< the moduli go with this power of the strength
    integer :: line = 0
  end type heterogeneity_group

contains

  subroutine heterogeneity_keys(group, table)
    type(heterogeneity_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('heterogeneity', group%line)
    call table%add('body', group%body)
    call table%add('material', group%material)
    call table%add('coefficient_of_variation', group%coefficient_of_variation, more_than=0.0_wp, at_most=1.0_wp, required=.true.)
    call table%add('correlation_length', group%correlation_length, of_length, more_than=0.0_wp, required=.true.)
    call table%add('correlation', group%correlation, [character(word_length) :: 'gaussian', 'exponential'])
    call table%add('distribution', group%distribution, [character(word_length) :: 'lognormal', 'weibull'])
    call table%add('seed', group%seed, at_least=0)
    call table%add('stiffness_exponent', group%stiffness_exponent, at_least=0.0_wp, at_most=2.0_wp)
  end subroutine heterogeneity_keys

end module deck_heterogeneity
