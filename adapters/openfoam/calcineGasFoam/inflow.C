#include "inflow.H"

namespace
{

using namespace Foam;

// Share of a flow in what a face's value is the mean of: of flows and the cell's gas at conductances.
scalarField shares(const scalarField& flow, const scalarField& conductance)
{
    scalarField share(flow.size(), Zero);
    forAll(share, i)
    {
        if (flow[i] > 0)
        {
            share[i] = flow[i]/(flow[i] + conductance[i]);
        }
    }
    return share;
}

} // End anonymous namespace


void Foam::calcine::inflow::add
(
    const fvPatch& patch,
    statedGas&& gas,
    const scalarField& diffusivity,
    const scalarField& conductivity,
    const scalarField& heatCapacity
)
{
    if (!gas.open)
    {
        const scalarField flow(gas.massFlux*patch.magSf());
        const scalarField reach(patch.magSf()*patch.deltaCoeffs());
        gas.fractionShare = shares(flow, diffusivity*reach);
        gas.heatShare = shares(flow*heatCapacity, conductivity*reach);
    }
    stated_.append(std::move(gas));
}


void Foam::calcine::inflow::seal(surfaceScalarField& diffusion) const
{
    for (const statedGas& gas : stated_)
    {
        diffusion.boundaryFieldRef()[gas.patch] == 0;
    }
}


void Foam::calcine::inflow::carry
(
    fvScalarMatrix& matrix,
    const surfaceScalarField& flux,
    label species
) const
{
    for (const statedGas& gas : stated_)
    {
        const scalarField& out = flux.boundaryField()[gas.patch];
        scalarField& own = matrix.internalCoeffs()[gas.patch];
        scalarField& given = matrix.boundaryCoeffs()[gas.patch];
        const scalar value = species < 0 ? gas.enthalpy : gas.fractions[species];
        forAll(out, i)
        {
            if (out[i] < 0)
            {
                own[i] = 0;
                given[i] = -out[i]*value;
            }
        }
    }
}


void Foam::calcine::inflow::state(volScalarField& T, PtrList<volScalarField>* Y) const
{
    for (const statedGas& gas : stated_)
    {
        if (gas.open)
        {
            continue;
        }
        T.boundaryFieldRef()[gas.patch] == gas.temperature;
        forAll(gas.fractions, k)
        {
            (*Y)[k].boundaryFieldRef()[gas.patch] == gas.fractions[k];
        }
    }
}


void Foam::calcine::inflow::mix(volScalarField& T, PtrList<volScalarField>* Y) const
{
    const auto set = [](fvPatchScalarField& face, scalar stated, const scalarField& share)
    {
        const scalarField inner(face.patchInternalField());
        face == inner + share*(stated - inner);
    };
    for (const statedGas& gas : stated_)
    {
        if (gas.open)
        {
            continue;
        }
        set(T.boundaryFieldRef()[gas.patch], gas.temperature, gas.heatShare);
        forAll(gas.fractions, k)
        {
            set((*Y)[k].boundaryFieldRef()[gas.patch], gas.fractions[k], gas.fractionShare);
        }
    }
}


bool Foam::calcine::inflow::has(label patch) const
{
    for (const statedGas& gas : stated_)
    {
        if (gas.patch == patch)
        {
            return true;
        }
    }
    return false;
}


bool Foam::calcine::inflow::opens() const
{
    bool any = false;
    for (const statedGas& gas : stated_)
    {
        any = any || gas.opening;
    }
    return returnReduce(any, orOp<bool>());
}


const Foam::calcine::statedGas* Foam::calcine::inflow::surroundings(label patch) const
{
    for (const statedGas& gas : stated_)
    {
        if (gas.opening && gas.patch == patch)
        {
            return &gas;
        }
    }
    return nullptr;
}


Foam::calcine::outerPressure Foam::calcine::inflow::pressure
(
    const statedGas& opening,
    const vector& centre,
    const vector& gravity,
    scalar pores,
    scalar flux
)
{
    const scalar still = opening.pressure + opening.density*(gravity & (centre - opening.at));
    const scalar inwards = max(-flux, scalar(0));
    const scalar slope = inwards/(opening.density*sqr(pores));
    return outerPressure{still + slope*inwards/2, slope};
}
