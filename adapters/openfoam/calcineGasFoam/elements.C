// Elements before species, as in Calcine's native gas. The iteration of reacting species (chemistry.C) carries what diffuses upstream or
// goes round from cell to cell only. But elements obey the equation of the species
// without what reactions make, as all species diffuse alike. So they are solved first, over the whole window at once; the species take them over,
// in proportion to what is there. What then has to be made of each, A Y - S, is the heat by which the enthalpy follows. Where the
// equations are solved nothing of this changes anything.
#include "gas.H"
#include "speciesTransport.H"
#include "fvm.H"

namespace
{

// An element that a cell lacks by less than this share of its gas is there.
const Foam::scalar noLack = 1e-9;

} // End anonymous namespace


// Each particle gives and takes by a law of its own, which no matrix of all species has.
bool Foam::calcine::gas::particlesExchangeGas() const
{
    scalar exchanged = gSumMag(given_.speciesHeat);
    forAll(given_.speciesSource, k)
    {
        exchanged += gSumMag(given_.speciesSource[k])
          + gSumMag(given_.speciesCoefficient[k]) + gSumMag(given_.speciesTaken[k]);
    }
    return exchanged > 0;
}


Foam::scalar Foam::calcine::gas::conserveElements(report& result)
{
    if (particlesExchangeGas_)
    {
        return 0;
    }
    PtrList<volScalarField>& Y = species_->Y();
    const speciesTransport transport(*this);
    PtrList<fvScalarMatrix> laplacians(Y.size()), equations(Y.size());
    forAll(Y, k)
    {
        laplacians.set(k, fvm::laplacian(transport.diffusion, Y[k]).ptr());
        equations.set(k, speciesEquation(k, transport, laplacians[k]).ptr());
    }
    fvScalarMatrix matrix(equations[0]);
    const List<scalarField> given(withoutReactions(equations, matrix));
    List<scalarField> masses;
    scalar residual = solveElements(matrix, given, masses, result);
    const labelList lacking(giveElements(masses));
    if (returnReduce(lacking.size(), sumOp<label>()) > 0)
    {
        bringSpecies(matrix, given, lacking, result);
    }

    heatMade_ = scalarField(mesh_.nCells(), Zero);
    PtrList<surfaceScalarField> diffused(Y.size());
    forAll(Y, k)
    {
        Y[k].correctBoundaryConditions();
        const scalarField made(-linear::residual(equations[k], Y[k]));
        heatMade_ -= species_->mixture()[k].formationEnthalpy()*made;
        diffused.set(k, (-laplacians[k].flux()).ptr());
    }
    carryEnthalpy(transport.limitedFlux, diffused);
    residual = max(residual, solveEnthalpy(result));
    guard(true);
    updateProperties();
    return residual;
}


// Right sides in kg/s of the equations of all species, what boundaries give included, which `matrix` then leaves out. Conditions of all
// species are of the same kinds, and so they have one matrix.
Foam::List<Foam::scalarField> Foam::calcine::gas::withoutReactions
(
    const PtrList<fvScalarMatrix>& equations,
    fvScalarMatrix& matrix
) const
{
    List<scalarField> given(equations.size());
    forAll(equations, k)
    {
        given[k] = equations[k].source();
        forAll(mesh_.boundary(), patchi)
        {
            const fvPatch& patch = mesh_.boundary()[patchi];
            if (patch.coupled())
            {
                continue;
            }
            const scalarField& inflow = equations[k].boundaryCoeffs()[patchi];
            forAll(patch, i)
            {
                given[k][patch.faceCells()[i]] += inflow[i];
            }
            matrix.boundaryCoeffs()[patchi] = Zero;
        }
    }
    return given;
}


// Mass of each element in a unit mass of gas at the end of the window, from the equations of the species.
Foam::scalar Foam::calcine::gas::solveElements
(
    fvScalarMatrix& matrix,
    const List<scalarField>& given,
    List<scalarField>& masses,
    report& result
)
{
    const PtrList<volScalarField>& Y = species_->Y();
    scalar residual = 0;
    const scalar content = gSumMag(matrix.diag());
    const scalar target = speciesTarget(Y.size() - 1, matrix.diag());
    volScalarField element("element", Y[0]);
    masses.setSize(reactions_->elements().size());
    forAll(masses, e)
    {
        const scalarList& shares = reactions_->elements()[e];
        scalarField source(mesh_.nCells(), Zero), before(mesh_.nCells(), Zero);
        forAll(Y, k)
        {
            source += shares[k]*given[k];
            before += shares[k]*Y[k].primitiveField();
        }
        element.primitiveFieldRef() = before;
        element.correctBoundaryConditions();
        const solved solution = speciesSolver_->solve(matrix, source, target, element);
        result.linearIterations += solution.iterations;
        residual = max(residual, solution.initial/content);
        masses[e] = element.primitiveField();
    }
    return residual;
}


// Gives cells the gas that would be there without reactions. It has the elements that are solved for, as its species obey the same
// equation.
void Foam::calcine::gas::bringSpecies
(
    fvScalarMatrix& matrix,
    const List<scalarField>& given,
    const labelList& lacking,
    report& result
)
{
    PtrList<volScalarField>& Y = species_->Y();
    const scalar target = speciesTarget(Y.size() - 1, matrix.diag());
    volScalarField inert("inert", Y[0]);
    forAll(Y, k)
    {
        inert.primitiveFieldRef() = committed_.composition[k];
        inert.correctBoundaryConditions();
        result.linearIterations += speciesSolver_->solve(matrix, given[k], target, inert).iterations;
        for (const label celli : lacking)
        {
            Y[k].primitiveFieldRef()[celli] = max(inert.primitiveField()[celli], scalar(0));
        }
    }
}


// The species of each cell take these masses of elements over, in proportion to what is there; the cells whose species cannot have them,
// as where gas of other elements comes in. Negative fractions stay, which
// corrections of diffusion leave beside steep gradients on skewed meshes: cut and made again they would never settle.
Foam::labelList Foam::calcine::gas::giveElements(const List<scalarField>& masses)
{
    DynamicList<label> lacking;
    PtrList<volScalarField>& Y = species_->Y();
    scalarList fractions(Y.size()), below(Y.size());
    scalarList wanted(masses.size()), found(masses.size());
    forAll(mass_, celli)
    {
        forAll(Y, k)
        {
            fractions[k] = Y[k].primitiveField()[celli];
        }
        // Less than nothing of an element, which corrections of diffusion leave, no species can have.
        const auto lack = [&](bool missing)
        {
            reactions_->elementsOf(fractions, found);
            scalar worst = 0;
            forAll(masses, e)
            {
                worst = max(worst, missing ? wanted[e] - found[e] : mag(wanted[e] - found[e]));
            }
            return worst;
        };
        forAll(masses, e)
        {
            wanted[e] = masses[e][celli];
        }
        if (lack(false) < noLack)
        {
            continue;
        }
        forAll(Y, k)
        {
            below[k] = min(fractions[k], scalar(0));
            fractions[k] -= below[k];
        }
        reactions_->elementsOf(below, found);
        forAll(masses, e)
        {
            wanted[e] -= found[e];
        }
        reactions_->restoreElements(wanted, fractions);
        if (lack(true) >= noLack)
        {
            lacking.append(celli);
        }
        // What is missing of an element that is there in traces is round-off of the others.
        const scalar all = sum(fractions) + sum(below);
        forAll(Y, k)
        {
            Y[k].primitiveFieldRef()[celli] = (fractions[k] + below[k])/all;
        }
    }
    return labelList(lacking);
}
