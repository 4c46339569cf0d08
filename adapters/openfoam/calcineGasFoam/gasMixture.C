#include "gasMixture.H"

#include <limits>

namespace
{

// J/mol/K.
const Foam::scalar gasConstant = 8.314462618;

// Bounds in K of the temperature of an enthalpy: a solver may pass the polynomials' range on its way.
const Foam::scalar coldest = 1, hottest = 2e4;

// Relative step at which Newton's method has converged: the next would be its square.
const Foam::scalar convergedStep = 1e-9;
const Foam::label mostSteps = 200;

} // End anonymous namespace


Foam::calcine::gasMixture::gasMixture(const dictionary& dict)
:
    names_(dict.get<wordList>("species")),
    species_(names_.size()),
    massRatios_(names_.size()*names_.size()),
    scales_(names_.size()*names_.size()),
    amounts_(names_.size()),
    viscosities_(names_.size()),
    roots_(names_.size())
{
    const label count = names_.size();
    forAll(names_, k)
    {
        species_.set(k, new gasSpecies(dict.subDict(names_[k])));
    }
    forAll(names_, i)
    {
        forAll(names_, j)
        {
            const scalar ratio = species_[j].molarMass()/species_[i].molarMass();
            massRatios_[i*count + j] = sqrt(sqrt(ratio));
            scales_[i*count + j] = 1/sqrt(8*(1 + 1/ratio));
        }
    }
}


Foam::scalar Foam::calcine::gasMixture::compressibility
(
    scalar temperature,
    const UList<scalar>& Y
) const
{
    scalar moles = 0;
    forAll(species_, k)
    {
        moles += Y[k]/species_[k].molarMass();
    }
    return 1/(moles*gasConstant*temperature);
}


Foam::scalar Foam::calcine::gasMixture::heatCapacity
(
    scalar temperature,
    const UList<scalar>& Y
) const
{
    scalar sum = 0;
    forAll(species_, k)
    {
        sum += Y[k]*species_[k].heatCapacity(temperature);
    }
    return sum;
}


Foam::scalar Foam::calcine::gasMixture::enthalpy
(
    scalar temperature,
    const UList<scalar>& Y
) const
{
    scalar sum = 0;
    forAll(species_, k)
    {
        sum += Y[k]*species_[k].enthalpy(temperature);
    }
    return sum;
}


Foam::scalar Foam::calcine::gasMixture::temperature
(
    scalar wanted,
    const UList<scalar>& Y,
    scalar guess
) const
{
    scalar low = coldest, high = hottest;
    scalar t = guess >= low && guess <= high ? guess : 0.5*(low + high);
    for (label step = 0; step < mostSteps; ++step)
    {
        const scalar h = enthalpy(t, Y);
        (h > wanted ? high : low) = t;
        const scalar next = t - (h - wanted)/heatCapacity(t, Y);
        if (next >= low && next <= high && mag(next - t) <= convergedStep*t)
        {
            return next;
        }
        if (high - low <= std::numeric_limits<scalar>::epsilon()*high)
        {
            break;
        }
        t = next > low && next < high ? next : 0.5*(low + high);
    }
    const bool inside = low > coldest && high < hottest;
    return inside ? low : std::numeric_limits<scalar>::quiet_NaN();
}


void Foam::calcine::gasMixture::transport
(
    scalar temperature,
    const UList<scalar>& Y,
    scalar& viscosity,
    scalar& conductivity
) const
{
    const label count = species_.size();
    forAll(species_, k)
    {
        amounts_[k] = Y[k]/species_[k].molarMass();
        viscosities_[k] = species_[k].viscosity(temperature);
        roots_[k] = sqrt(viscosities_[k]);
    }
    viscosity = 0;
    conductivity = 0;
    forAll(species_, i)
    {
        if (amounts_[i] == 0)
        {
            continue;
        }
        scalar sum = 0;
        forAll(species_, j)
        {
            const label pair = i*count + j;
            sum += amounts_[j]*sqr(1 + roots_[i]/roots_[j]*massRatios_[pair])*scales_[pair];
        }
        const scalar weight = amounts_[i]/sum;
        viscosity += weight*viscosities_[i];
        conductivity += weight*species_[i].conductivity(temperature, viscosities_[i]);
    }
}
