#include "gasChemistry.H"

#include <cmath>

namespace
{

using namespace Foam;

// kmol/m3 below which a power of an order below 1 goes on as a straight line, as in Calcine's coordinator.
const scalar straight = 1e-9;
// K between which a step that an integration tries, and will take back, evaluates rates.
const scalar coldest = 200, hottest = 5000;

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
    slopes_(nSpecie_)
{}


void Foam::calcine::gasChemistry::solve
(
    scalarField&,
    scalar&,
    scalar&,
    scalar&,
    scalar&
) const
{
    FatalErrorInFunction << "cells are integrated with what flows through them" << exit(FatalError);
}


Foam::scalar Foam::calcine::gasChemistry::bounded(scalar T)
{
    // NaN is not hotter.
    return T > coldest ? min(T, hottest) : coldest;
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


Foam::scalar Foam::calcine::gasChemistry::rates
(
    const scalarField& c,
    scalar T,
    scalar p,
    scalarField& slope
) const
{
    slope = Zero;
    scalar gained = 0, pf, cf, pr, cr;
    label left, right;
    for (const reaction& r : reactions_)
    {
        const scalar rate = omega(r, c, T, p, pf, cf, left, pr, cr, right);
        for (const auto& one : r.lhs())
        {
            slope[one.index] -= one.stoichCoeff*rate;
        }
        for (const auto& one : r.rhs())
        {
            slope[one.index] += one.stoichCoeff*rate;
            gained += one.stoichCoeff*pf*cf;
        }
    }
    return gained;
}


void Foam::calcine::gasChemistry::addSlopes
(
    const List<reaction::specieCoeffs>& side,
    const scalarField& c,
    scalar k,
    scalarField& slopes
)
{
    forAll(side, i)
    {
        scalar others = k;
        forAll(side, j)
        {
            others *= j == i ? scalar(1) : power(c[side[j].index], side[j].exponent);
        }
        slopes[side[i].index] += others*slopeOfPower(c[side[i].index], side[i].exponent);
    }
}


void Foam::calcine::gasChemistry::slopes
(
    const scalarField& c,
    scalar T,
    scalar p,
    scalarSquareMatrix& byConcentration,
    scalarField& gained
) const
{
    byConcentration = Zero;
    gained = Zero;
    for (const reaction& r : reactions_)
    {
        const scalar forth = r.kf(p, T, c), back = r.kr(forth, p, T, c);
        slopes_ = Zero;
        addSlopes(r.lhs(), c, forth, slopes_);
        scalar numbers = 0;
        for (const auto& one : r.rhs())
        {
            numbers += one.stoichCoeff;
        }
        gained += numbers*slopes_;
        addSlopes(r.rhs(), c, -back, slopes_);
        for (label j = 0; j < nSpecie_; ++j)
        {
            for (const auto& one : r.lhs())
            {
                byConcentration(one.index, j) -= one.stoichCoeff*slopes_[j];
            }
            for (const auto& one : r.rhs())
            {
                byConcentration(one.index, j) += one.stoichCoeff*slopes_[j];
            }
        }
    }
}
