#include "gasChemistry.H"

#include <cmath>

namespace
{

using namespace Foam;

// kmol/m3 below which a power of an order below 1 goes on as a straight line, as in Calcine's coordinator.
const scalar straight = 1e-9;
// K between which a step that an integration tries, and will take back, evaluates rates.
const scalar coldest = 200, hottest = 5000;
// kmol/m3, of such a step: more than there is in any gas.
const scalar densest = 1e3;
// J/(m3 K): a gas at 5000 K has this at 1 Pa.
const scalar leastCapacity = 1e-3;
// K, of the difference quotients by temperature.
const scalar apart = 1e-2;

scalar bounded(scalar T)
{
    // NaN is not hotter.
    return T > coldest ? min(T, hottest) : coldest;
}

scalar power(scalar c, scalar order)
{
    if (order == 1)
    {
        return c;
    }
    return order < 1 && order > 0 && c < straight ? c*std::pow(straight, order - 1) : std::pow(c, order);
}

scalar slopeOfPower(scalar c, scalar order)
{
    if (order == 1 || order == 0)
    {
        return order;
    }
    return order < 1 && c < straight ? std::pow(straight, order - 1) : order*std::pow(c, order - 1);
}

template<class Side>
scalar product(const Side& side, const scalarField& c)
{
    scalar result = 1;
    for (const auto& one : side)
    {
        result *= power(c[one.index], one.exponent);
    }
    return result;
}

} // End anonymous namespace


namespace Foam
{
namespace calcine
{

defineTypeNameAndDebug(gasChemistry, 0);

} // End namespace calcine
} // End namespace Foam


Foam::calcine::gasChemistry::gasChemistry(psiReactionThermo& thermo)
:
    StandardChemistryModel<psiReactionThermo, gasHThermoPhysics>(thermo),
    positive_(nSpecie_),
    hotter_(nSpecie_ + 2),
    colder_(nSpecie_ + 2),
    slopes_(nSpecie_)
{}


void Foam::calcine::gasChemistry::setPositive(const scalarField& c) const
{
    forAll(positive_, i)
    {
        // NaN is not positive.
        positive_[i] = c[i] > 0 ? min(c[i], densest) : 0;
    }
}


Foam::scalar Foam::calcine::gasChemistry::heatCapacity(scalar p, scalar T) const
{
    scalar capacity = 0;
    for (label i = 0; i < nSpecie_; ++i)
    {
        capacity += specieThermo_[i].cp(p, T)*positive_[i];
    }
    return max(capacity, leastCapacity);
}


Foam::scalar Foam::calcine::gasChemistry::omega
(
    const reaction& r,
    const scalarField& c,
    const scalar T,
    const scalar p,
    scalar& pf,
    scalar& cf,
    label& lRef,
    scalar& pr,
    scalar& cr,
    label& rRef
) const
{
    pf = r.kf(p, T, c);
    pr = r.kr(pf, p, T, c);
    cf = product(r.lhs(), c);
    cr = product(r.rhs(), c);
    lRef = r.lhs()[0].index;
    rRef = r.rhs()[0].index;
    return pf*cf - pr*cr;
}


void Foam::calcine::gasChemistry::derivatives
(
    const scalar,
    const scalarField& c,
    scalarField& slope
) const
{
    setPositive(c);
    const scalar T = bounded(c[nSpecie_]), p = c[nSpecie_ + 1];
    omega(positive_, T, p, slope);
    scalar heat = 0;
    for (label i = 0; i < nSpecie_; ++i)
    {
        heat -= specieThermo_[i].ha(p, T)*slope[i];
    }
    slope[nSpecie_] = heat/heatCapacity(p, T);
    slope[nSpecie_ + 1] = 0;
}


void Foam::calcine::gasChemistry::addSlopes
(
    const List<reaction::specieCoeffs>& side,
    const scalarField& c,
    scalar k
) const
{
    forAll(side, i)
    {
        scalar others = k;
        forAll(side, j)
        {
            others *= j == i ? scalar(1) : power(c[side[j].index], side[j].exponent);
        }
        slopes_[side[i].index] += others*slopeOfPower(c[side[i].index], side[i].exponent);
    }
}


void Foam::calcine::gasChemistry::jacobian
(
    const scalar time,
    const scalarField& c,
    scalarField& byTime,
    scalarSquareMatrix& byState
) const
{
    byTime = Zero;
    byState = Zero;

    // By temperature.
    scalarField moved(c);
    moved[nSpecie_] = bounded(c[nSpecie_]) + apart;
    derivatives(time, moved, hotter_);
    moved[nSpecie_] -= 2*apart;
    derivatives(time, moved, colder_);
    for (label i = 0; i <= nSpecie_; ++i)
    {
        byState(i, nSpecie_) = (hotter_[i] - colder_[i])/(2*apart);
    }

    // By concentrations.
    setPositive(c);
    const scalar T = bounded(c[nSpecie_]), p = c[nSpecie_ + 1];
    for (const reaction& r : reactions_)
    {
        const scalar forth = r.kf(p, T, positive_), back = r.kr(forth, p, T, positive_);
        slopes_ = Zero;
        addSlopes(r.lhs(), positive_, forth);
        addSlopes(r.rhs(), positive_, -back);
        for (label j = 0; j < nSpecie_; ++j)
        {
            for (const auto& one : r.lhs())
            {
                byState(one.index, j) -= one.stoichCoeff*slopes_[j];
            }
            for (const auto& one : r.rhs())
            {
                byState(one.index, j) += one.stoichCoeff*slopes_[j];
            }
        }
    }
    const scalar slope = 0.5*(hotter_[nSpecie_] + colder_[nSpecie_]);
    const scalar capacity = heatCapacity(p, T);
    for (label j = 0; j < nSpecie_; ++j)
    {
        scalar heat = -specieThermo_[j].cp(p, T)*slope;
        for (label i = 0; i < nSpecie_; ++i)
        {
            heat -= specieThermo_[i].ha(p, T)*byState(i, j);
        }
        byState(nSpecie_, j) = heat/capacity;
    }
}
