#include "gasSpecies.H"

namespace
{

// J/mol/K, exact in the SI of 2019; OpenFOAM's own constant is an older one.
const Foam::scalar gasConstant = 8.314462618;

// h/R in K of one range.
Foam::scalar within(const Foam::FixedList<Foam::scalar, 7>& a, Foam::scalar t)
{
    return a[5] + t*(a[0] + t*(a[1]/2 + t*(a[2]/3 + t*(a[3]/4 + t*(a[4]/5)))));
}

} // End anonymous namespace


Foam::calcine::gasSpecies::gasSpecies(const dictionary& dict)
:
    molarMass_(dict.get<scalar>("molarMass")),
    gasConstant_(gasConstant/molarMass_),
    lowest_(dict.get<scalar>("Tlow")),
    common_(dict.get<scalar>("Tcommon")),
    highest_(dict.get<scalar>("Thigh")),
    low_(dict.lookup("lowCpCoeffs")),
    high_(dict.lookup("highCpCoeffs")),
    sutherlandCoefficient_(dict.get<scalar>("As")),
    sutherlandTemperature_(dict.get<scalar>("Ts")),
    reference_(0)
{
    if (!(molarMass_ > 0 && lowest_ > 0 && lowest_ < common_ && common_ < highest_))
    {
        FatalIOErrorInFunction(dict)
            << "a molar mass of " << molarMass_ << " kg/mol and temperatures of " << lowest_
            << ", " << common_ << " and " << highest_ << " K; all must be positive and the latter rise"
            << exit(FatalIOError);
    }
    reference_ = molarEnthalpy(298.15);
}


const Foam::FixedList<Foam::scalar, 7>& Foam::calcine::gasSpecies::at(scalar& temperature) const
{
    temperature = min(max(temperature, lowest_), highest_);
    return temperature <= common_ ? low_ : high_;
}


Foam::scalar Foam::calcine::gasSpecies::molarEnthalpy(scalar temperature) const
{
    scalar t = temperature;
    const auto& a = at(t);
    const scalar inside = within(a, t);
    return t == temperature ? inside
      : inside + heatCapacity(t)/gasConstant_*(temperature - t);
}


Foam::scalar Foam::calcine::gasSpecies::heatCapacity(scalar temperature) const
{
    scalar t = temperature;
    const auto& a = at(t);
    return gasConstant_*(a[0] + t*(a[1] + t*(a[2] + t*(a[3] + t*a[4]))));
}


Foam::scalar Foam::calcine::gasSpecies::enthalpy(scalar temperature) const
{
    return gasConstant_*(molarEnthalpy(temperature) - reference_);
}


Foam::scalar Foam::calcine::gasSpecies::viscosity(scalar temperature) const
{
    return sutherlandCoefficient_*sqrt(temperature)/(1 + sutherlandTemperature_/temperature);
}


Foam::scalar Foam::calcine::gasSpecies::conductivity(scalar temperature, scalar viscosity) const
{
    return
        viscosity*(1.32*(heatCapacity(temperature) - gasConstant_) + 1.77*gasConstant_);
}
