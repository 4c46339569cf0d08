#include "stirredCell.H"
#include "physicoChemicalConstants.H"

namespace
{

using namespace Foam;

// mol in a kmol.
const scalar kilo = 1e3;
// K, of difference quotients by temperature.
const scalar apart = 1e-2;

} // End anonymous namespace


Foam::calcine::stirredCell::stirredCell
(
    const gasChemistry& chemistry,
    const gasMixture& mixture,
    const labelList& own
)
:
    chemistry_(chemistry),
    mixture_(mixture),
    own_(own),
    species_(own.size()),
    concentrations_(own.size()),
    below_(own.size()),
    rates_(own.size()),
    hotter_(own.size()),
    colder_(own.size()),
    gainedSlopes_(own.size()),
    slopes_(own.size()),
    made_(own.size())
{}


void Foam::calcine::stirredCell::set
(
    const throughflow& flow,
    scalar pressure,
    scalar time,
    scalar start
)
{
    start_ = start;
    flow_ = &flow;
    pressure_ = pressure;
    time_ = time;
}


void Foam::calcine::stirredCell::setConcentrations
(
    const scalarField& y,
    scalar T,
    scalar& density,
    scalar& moles
) const
{
    moles = 0;
    for (label k = 0; k < species_; ++k)
    {
        moles += max(y[k], scalar(0))/(kilo*mixture_[k].molarMass());
    }
    // An integration may try what is no gas, and takes it back.
    moles = max(moles, VSMALL);
    density = pressure_/(constant::physicoChemical::R.value()*kilo*T*moles);
    isBelow_ = false;
    for (label k = 0; k < species_; ++k)
    {
        const scalar c = y[k]*density/(kilo*mixture_[k].molarMass());
        concentrations_[own_[k]] = max(c, scalar(0));
        below_[own_[k]] = min(c, scalar(0));
        isBelow_ = isBelow_ || c < 0;
    }
}


Foam::scalar Foam::calcine::stirredCell::extended(scalar gained) const
{
    for (label l = 0; l < species_; ++l)
    {
        const label j = own_[l];
        gained += gainedSlopes_[j]*below_[j];
        for (label k = 0; k < species_; ++k)
        {
            rates_[own_[k]] += slopes_(own_[k], j)*below_[j];
        }
    }
    return gained;
}


Foam::scalar Foam::calcine::stirredCell::share(scalar gained, scalar density, scalar moles) const
{
    // t_c = n sum c/gained.
    const scalar all = chemistry_.nReaction()*density*moles;
    return 1/(density*(1 + flow_->mixing*max(gained, scalar(0))/all));
}


void Foam::calcine::stirredCell::finish
(
    const scalarField& y,
    scalar T,
    scalar density,
    scalarField& slope
) const
{
    const scalar r = held(density);
    scalar heating = flow_->heatEntering/r, capacity = 0;
    for (label k = 0; k < species_; ++k)
    {
        const gasSpecies& one = mixture_[k];
        const scalar carried = (flow_->entering[k] - flow_->leaving[k]*y[k])/r;
        const scalar h = one.enthalpy(T);
        slope[k] = made_[k] + carried;
        slope[species_ + 1 + k] = r*made_[k]/(1 + flow_->leaving[k]*time_);
        // With h = sum Y_k h_k.
        heating -= made_[k]*(h + one.formationEnthalpy()) + (carried + flow_->heatLeaving*y[k]/r)*h;
        capacity += max(y[k], scalar(0))*one.heatCapacity(T);
    }
    slope[species_] = heating/max(capacity, SMALL);
}


void Foam::calcine::stirredCell::derivatives
(
    const scalar,
    const scalarField& y,
    scalarField& slope
) const
{
    const scalar T = gasChemistry::bounded(y[species_]);
    scalar density, moles;
    setConcentrations(y, T, density, moles);
    scalar gained = chemistry_.rates(concentrations_, T, pressure_, rates_);
    if (isBelow_)
    {
        chemistry_.slopes(concentrations_, T, pressure_, slopes_, gainedSlopes_);
        gained = extended(gained);
    }
    const scalar perMass = share(gained, density, moles);
    for (label k = 0; k < species_; ++k)
    {
        made_[k] = kilo*mixture_[k].molarMass()*rates_[own_[k]]*perMass;
    }
    finish(y, T, density, slope);
}


void Foam::calcine::stirredCell::jacobian
(
    const scalar,
    const scalarField& y,
    scalarField& byTime,
    scalarSquareMatrix& byState
) const
{
    byTime = Zero;
    byState = Zero;
    const scalar T = gasChemistry::bounded(y[species_]);
    scalar density, moles;
    setConcentrations(y, T, density, moles);

    // By temperature, at fixed concentrations.
    const scalar hotter = chemistry_.rates(concentrations_, T + apart, pressure_, hotter_);
    const scalar colder = chemistry_.rates(concentrations_, T - apart, pressure_, colder_);
    // By concentrations.
    scalar gained = chemistry_.rates(concentrations_, T, pressure_, rates_);
    chemistry_.slopes(concentrations_, T, pressure_, slopes_, gainedSlopes_);
    if (isBelow_)
    {
        gained = extended(gained);
        concentrations_ += below_;
    }

    const scalar perMass = share(gained, density, moles);
    // kappa/rho = 1/(rho + mixing gained/(n sum Y/M)): its slope is -(kappa/rho)^2 times that of the divisor.
    const scalar pull = gained > 0 ? flow_->mixing/(chemistry_.nReaction()*moles) : 0;
    // Slope of the density by T is -density/T, by Y_l -density/(moles M_l).
    scalarField slopeOfMade(species_);
    const auto column = [&](label l, scalar molarMass)
    {
        // d c_j = (rho delta_jl/M_l) + c_j d rho/rho; the relative slope of the density:
        const scalar relative = l < species_ ? -1/(moles*molarMass) : -1/T;
        scalar gainedSlope = l < species_ ? 0 : (hotter - colder)/(2*apart);
        for (label j = 0; j < species_; ++j)
        {
            gainedSlope += gainedSlopes_[own_[j]]*concentrations_[own_[j]]*relative;
        }
        if (l < species_)
        {
            gainedSlope += gainedSlopes_[own_[l]]*density/molarMass;
        }
        const scalar molesSlope = l < species_ ? 1/molarMass : 0;
        const scalar divisorSlope =
            density*relative + pull*(gainedSlope - gained*molesSlope/moles);
        for (label k = 0; k < species_; ++k)
        {
            const label i = own_[k];
            scalar slope = l < species_ ? slopes_(i, own_[l])*density/molarMass : (hotter_[i] - colder_[i])/(2*apart);
            for (label j = 0; j < species_; ++j)
            {
                slope += slopes_(i, own_[j])*concentrations_[own_[j]]*relative;
            }
            slopeOfMade[k] = kilo*mixture_[k].molarMass()
               *(slope*perMass - rates_[i]*sqr(perMass)*divisorSlope);
        }
    };

    const scalar r = held(density);
    scalar capacity = 0, capacitySlope = 0, heating = flow_->heatEntering/r;
    scalarField h(species_), c(species_), carried(species_);
    for (label k = 0; k < species_; ++k)
    {
        const gasSpecies& one = mixture_[k];
        h[k] = one.enthalpy(T);
        c[k] = one.heatCapacity(T);
        made_[k] = kilo*one.molarMass()*rates_[own_[k]]*perMass;
        capacity += max(y[k], scalar(0))*c[k];
        capacitySlope += max(y[k], scalar(0))
           *(one.heatCapacity(T + apart) - one.heatCapacity(T - apart))/(2*apart);
        carried[k] = (flow_->entering[k] - flow_->leaving[k]*y[k])/r;
        heating -= made_[k]*(h[k] + one.formationEnthalpy())
          + (carried[k] + flow_->heatLeaving*y[k]/r)*h[k];
    }
    capacity = max(capacity, SMALL);
    for (label l = 0; l <= species_; ++l)
    {
        const bool fraction = l < species_;
        column(l, fraction ? kilo*mixture_[l].molarMass() : scalar(1));
        // Slope of r, and its relative one.
        const scalar relative = fraction ? -1/(moles*kilo*mixture_[l].molarMass()) : -1/T;
        const scalar slopeOfHeld = flow_->opening*density/start_*relative;
        scalar heat = -flow_->heatEntering/sqr(r)*slopeOfHeld;
        for (label k = 0; k < species_; ++k)
        {
            const scalar thinned = carried[k]/r*slopeOfHeld;
            byState(k, l) = slopeOfMade[k] - thinned;
            byState(species_ + 1 + k, l) =
                (r*slopeOfMade[k] + slopeOfHeld*made_[k])/(1 + flow_->leaving[k]*time_);
            heat -= slopeOfMade[k]*(h[k] + mixture_[k].formationEnthalpy())
              - (thinned + flow_->heatLeaving*y[k]/sqr(r)*slopeOfHeld)*h[k];
            if (!fraction)
            {
                heat -= (made_[k] + carried[k] + flow_->heatLeaving*y[k]/r)*c[k];
            }
        }
        if (fraction)
        {
            byState(l, l) -= flow_->leaving[l]/r;
            heat += (flow_->leaving[l] - flow_->heatLeaving)/r*h[l];
        }
        byState(species_, l) =
            (heat - heating/capacity*(fraction ? c[l] : capacitySlope))/capacity;
    }
}
