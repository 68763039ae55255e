!> What follows from the form p = f(r) + g r e with a constant g, whatever f is. f, r_df: f and r df/dr at the density r.
module mie_grueneisen
  use kinds, only: wp
  implicit none
  private
  public :: pressure_from, energy_from, sound_speed_squared_from, pressure_without_sound

contains

  !> Pressure at density r and energy per mass e.
  elemental real(wp) function pressure_from(f, g, r, e)
    real(wp), intent(in) :: f, g, r, e
    pressure_from = f + g*r*e
  end function pressure_from

  !> Energy per mass at density r and pressure p.
  elemental real(wp) function energy_from(f, g, r, p)
    real(wp), intent(in) :: f, g, r, p
    energy_from = (p - f)/(g*r)
  end function energy_from

  !> c**2 at density r and pressure p: c**2 = dp/dr at constant e + (p/r**2) dp/de, so that r c**2 = r f' + p - f + g p.
  elemental real(wp) function sound_speed_squared_from(f, r_df, g, r, p)
    real(wp), intent(in) :: f, r_df, g, r, p
    sound_speed_squared_from = (r_df + p - f + g*p)/r
  end function sound_speed_squared_from

  !> The pressure at which c**2 vanishes. Matter without a gas' pressure comes apart there; under tension it is negative.
  elemental real(wp) function pressure_without_sound(f, r_df, g)
    real(wp), intent(in) :: f, r_df, g
    pressure_without_sound = (f - r_df)/(1 + g)
  end function pressure_without_sound

end module mie_grueneisen
