!> The equation of state of a material of the deck.
module material_eos
  use deck_material, only: material_group
  use equation_of_state, only: eos_type, new_ideal_gas, new_stiffened_gas, new_jwl, new_cochran_chan, new_shock, new_polynomial
  use errors, only: fatal, exit_bad_input
  use text, only: lowercase
  implicit none
  private
  public :: eos_of

contains

  !> Equation of state of a material group. Fatal (bad input) where it has none.
  function eos_of(group) result(eos)
    type(material_group), intent(in) :: group
    type(eos_type) :: eos
    select case (lowercase(trim(group%eos)))
    case ('ideal_gas')
      eos = new_ideal_gas(group%gamma, group%energy_offset)
    case ('stiffened_gas')
      eos = new_stiffened_gas(group%gamma, group%p_infinity, group%energy_offset)
    case ('jwl')
      eos = new_jwl(group%jwl_a, group%jwl_b, group%jwl_r1, group%jwl_r2, group%jwl_omega, group%density, &
        group%energy_per_volume)
    case ('cochran_chan')
      eos = new_cochran_chan(group%cochran_chan_a1, group%cochran_chan_a2, group%cochran_chan_e1, group%cochran_chan_e2, &
        group%grueneisen, group%density)
    case ('shock')
      eos = new_shock(group%sound_speed, group%hugoniot_slope, group%grueneisen, group%density)
    case ('polynomial')
      eos = new_polynomial(group%polynomial_k1, group%polynomial_k2, group%polynomial_k3, group%grueneisen, group%density)
    case default
      call fatal('material '''//trim(group%name)//''': there is no equation of state '''//trim(group%eos)//'''', exit_bad_input)
    end select
  end function eos_of

end module material_eos
