// Reactions of the gas with itself by balanced splitting, in species and enthalpy alike, as in Calcine's native gas (docs/theory.md, CHM-2). The
// equation of each species is per cell
//
//   m_old (Y - Y_old)/dtau + D' Y = b' + M,
//
// D' Y what leaves the cell with its own gas and by diffusion from it, b' what enters, the neighbours' share included. M is what a stirred
// reactor makes in the mean of the window, which starts with the cell's old gas and into which b' flows:
//
//   dY/dt = w(Y, T) + (b' - D' Y)/m,   M = int m w dt/dtau,   m = m_old (1 + theta (rho/rho_old - 1)),
//
// theta = F/(m_old/dtau + F), F what flows in and comes from particles, as flow fills a cell whose gas contracts and carries away what expands,
// which diffusion does not. So a steady cell is a stirred reactor at any span and storage, and one without flow a closed one, whatever diffuses
// between cells. M is free of every element to round-off. b' is found by nonlinear Gauss-Seidel iteration: cells are visited downstream, each
// with the newest gas of those above it, and all go on from there by Newton's step (newtonStep.H). Across borders between ranks the last
// iterate is taken.
#include "gas.H"
#include "clockValue.H"
#include "link.H"
#include "newtonStep.H"
#include "speciesTransport.H"
#include "fvm.H"
#include "OStringStream.H"

namespace
{

// Sweeps in an outer iteration at most.
const Foam::label mostSweeps = 5;
// They need not change a value by less than this share of the residual of momentum and continuity, whose fluxes they take.
const Foam::scalar closer = 0.1;
// Share of what leaves a cell that is round-off of what diffuses through it.
const Foam::scalar roundOff = 1e-12;
// A reactor is not run again while what enters has changed by less than this share of the outer tolerance.
const Foam::scalar same = 0.1;
// Solves at the end of an attempt by which fractions below zero are taken out of what reacts, at most.
const Foam::label closings = 3;

} // End anonymous namespace


void Foam::calcine::gas::beginReactions()
{
    if (!reactions_)
    {
        return;
    }
    speciesMade_ = List<scalarField>(species_->Y().size(), scalarField(mesh_.nCells(), Zero));
    heatMade_ = scalarField(mesh_.nCells(), Zero);
    reactions_->begin(mesh_.nCells());
    particlesExchangeGas_ = particlesExchangeGas();
    mixingTime_ = scalarField(mesh_.nCells(), Zero);
    if (reactions_->mixingConstant() >= 0)
    {
        mixingTime_ = reactions_->mixingConstant()
           *models_->mixingTime(thermo_->mu()().primitiveField(), density());
    }
    const scalarField content(thermo_->Cp()().primitiveField()*thermo_->T().primitiveField());
    enthalpyUnit_ = content.size() ? max(content) : scalar(1);
}


// Cells behind those that they get gas from. Where gas goes round, the first of the round that is found in the order of the cells
// opens it.
Foam::labelList Foam::calcine::gas::downstream() const
{
    const label internal = mesh_.nInternalFaces();
    const labelUList& owner = mesh_.faceOwner();
    const labelUList& neighbour = mesh_.faceNeighbour();
    labelList order(mesh_.nCells());
    bitSet seen(mesh_.nCells());
    DynamicList<label> stack;
    label found = 0;
    forAll(order, first)
    {
        if (seen[first])
        {
            continue;
        }
        seen.set(first);
        stack.append(first);
        while (stack.size())
        {
            const label celli = stack.last();
            label next = -1;
            for (const label facei : mesh_.cells()[celli])
            {
                if (facei >= internal)
                {
                    continue;
                }
                const bool owns = owner[facei] == celli;
                const label other = owns ? neighbour[facei] : owner[facei];
                if ((owns ? flux_[facei] < 0 : flux_[facei] > 0) && !seen[other])
                {
                    next = other;
                    break;
                }
            }
            if (next >= 0)
            {
                seen.set(next);
                stack.append(next);
                continue;
            }
            order[found++] = celli;
            stack.remove();
        }
    }
    return order;
}


void Foam::calcine::gas::setHeatMade()
{
    heatMade_ = Zero;
    forAll(speciesMade_, k)
    {
        heatMade_ -= species_->mixture()[k].formationEnthalpy()*speciesMade_[k];
    }
}


// `flow`: the residual of momentum and continuity.
Foam::scalar Foam::calcine::gas::solveScalars(scalar flow, report& result)
{
    if (!reactions_)
    {
        const scalar residual = species_ ? solveSpecies(speciesTransport(*this), result) : 0;
        return max(residual, solveEnthalpy(result));
    }
    const scalar enough = max(outer_.tolerance, closer*flow);
    PtrList<volScalarField>& Y = species_->Y();
    scalar first = 0, change = 0;
    for (label sweep = 0; sweep < mostSweeps; ++sweep)
    {
        List<scalarField> fractions(Y.size());
        forAll(Y, k)
        {
            fractions[k] = Y[k].primitiveField();
        }
        const scalarField before(thermo_->T().primitiveField());
        const scalar residual = conserveElements(result);
        const clockValue begun(true);
        sweepReactions();
        reactionTime_ += begun.elapsed();
        guard(true);
        updateProperties();
        const scalarField& T = thermo_->T().primitiveField();
        change = gMax(mag(T - before)/T);
        forAll(Y, k)
        {
            change = max(change, gMax(mag(Y[k].primitiveField() - fractions[k])));
        }
        if (sweep == 0)
        {
            // The flow of this iteration is that of the fields before.
            first = max(residual, change);
        }
        if (change <= enough)
        {
            break;
        }
    }
    return max(first, change);
}


// Runs the reactors of all cells downstream and goes on by Newton's step; the fields become what they reach.
void Foam::calcine::gas::sweepReactions()
{
    PtrList<volScalarField>& Y = species_->Y();
    const label species = Y.size();
    const speciesTransport transport(*this);
    PtrList<fvScalarMatrix> laplacians(species), matrices(species);
    PtrList<surfaceScalarField> diffused(species);
    forAll(Y, k)
    {
        laplacians.set(k, fvm::laplacian(transport.diffusion, Y[k]).ptr());
        matrices.set(k, speciesEquation(k, transport, laplacians[k]).ptr());
        diffused.set(k, (-laplacians[k].flux()).ptr());
    }
    diffusedOut_ = -laplacians[0].diag();
    forAll(mesh_.boundary(), patchi)
    {
        const labelUList& cells = mesh_.boundary()[patchi].faceCells();
        forAll(cells, i)
        {
            diffusedOut_[cells[i]] -= laplacians[0].internalCoeffs()[patchi][i];
        }
    }
    carryEnthalpy(transport.limitedFlux, diffused);
    heatMade_ = Zero;
    assembleEnthalpy();
    const scalarEquations equations(matrices, Y, *enthalpy_, thermo_->he());

    newtonStep newton(mesh_, equations, downstream(), enthalpyUnit_, reactions_->runs());
    for (const label celli : newton.order)
    {
        runCell(celli, equations, newton);
    }
    newton.correct(Y, thermo_->he(), species_->mixture(), thermo_->T().primitiveField());
    forAll(Y, k)
    {
        Y[k].correctBoundaryConditions();
    }
    thermo_->he().correctBoundaryConditions();
    setHeatMade();
}


// The reactor of a cell, whose fractions and enthalpy become those at the end of the window.
void Foam::calcine::gas::runCell
(
    label celli,
    const scalarEquations& equations,
    newtonStep& newton
)
{
    PtrList<volScalarField>& Y = species_->Y();
    const gasMixture& mixture = species_->mixture();
    const label species = Y.size();
    scalarField& h = thermo_->he().primitiveFieldRef();
    const scalar guess = thermo_->T().primitiveField()[celli];
    scalarList given(species + 1), inert(species + 1), with(species + 4), reached(species);
    equations.enter(mesh_, celli, Y, thermo_->he(), given);
    forAll(inert, value)
    {
        inert[value] = given[value]/equations.diagonal[value][celli];
        with[value] = inert[value];
    }
    with[species + 1] = equations.diagonal[0][celli];
    with[species + 2] = equations.diagonal[species][celli];
    with[species + 3] = modelPressure_[celli];
    newton.note(celli, inert);

    forAll(reached, k)
    {
        reached[k] = max(Y[k].primitiveField()[celli], scalar(0));
    }
    const scalar content = mixture.heatCapacity(guess, reached)*guess;
    cellRun& run = reactions_->runs()[celli];
    const bool again = !run.is(with, same*outer_.tolerance, content);
    throughflow flow;
    scalarList start(species);
    bool reacts = false;
    if (again)
    {
        reacts = react(celli, equations, given, flow, start, run.made);
        run.with = with;
        run.response.clear();
    }

    scalar heat = 0;
    forAll(reached, k)
    {
        speciesMade_[k][celli] = run.made[k];
        heat -= mixture[k].formationEnthalpy()*run.made[k];
        reached[k] = (given[k] + run.made[k])/equations.diagonal[k][celli];
        Y[k].primitiveFieldRef()[celli] = reached[k];
    }
    h[celli] = (given[species] + heat)/equations.diagonal[species][celli];
    const scalar T = reacts ? mixture.temperature(h[celli], reached, guess) : 0;
    if (T > 0)
    {
        const scalar p = modelPressure_[celli];
        const scalar begun = p*mixture.compressibility(committed_.temperature[celli], start);
        run.response = scalarSquareMatrix(species + 1);
        reactions_->response
        (
            p, T, reached, flow, window_.storageSpan, begun, enthalpyUnit_, run.response
        );
    }
}


// What flows through a cell, the fractions that it starts with, and what its reactor makes in kg/s; whether anything reacts.
bool Foam::calcine::gas::react
(
    label celli,
    const scalarEquations& equations,
    const scalarList& given,
    throughflow& flow,
    scalarList& start,
    scalarList& made
)
{
    const label species = start.size();
    const scalar held = committed_.mass[celli], span = window_.storageSpan;
    const scalar storage = held/span;
    // An early iterate's fluxes may fill a cell; what leaves is then none.
    const auto leaving = [&](scalar diagonal)
    {
        return max(diagonal - storage, scalar(0))/held;
    };
    flow.entering.setSize(species);
    flow.leaving.setSize(species);
    scalar all = 0;
    forAll(start, k)
    {
        flow.entering[k] = (given[k] - storage*committed_.composition[k][celli])/held;
        flow.leaving[k] = leaving(equations.diagonal[k][celli]);
        start[k] = max(committed_.composition[k][celli], scalar(0));
        all += start[k];
    }
    for (scalar& y : start)
    {
        y /= all;
    }
    flow.heatEntering = (given[species] - storage*committed_.enthalpy[celli])/held;
    flow.heatLeaving = leaving(equations.diagonal[species][celli]);
    // Of what diffuses much faster, round-off is no flow.
    const scalar out = flow.leaving[0]*held, flows = out - diffusedOut_[celli];
    flow.opening = flows > roundOff*out ? flows/(storage + flows) : 0;
    flow.mixing = mixingTime_[celli];
    made.setSize(species);
    bool reacts = false;
    try
    {
        reacts = reactions_->flowThrough
        (
            modelPressure_[celli], committed_.temperature[celli], start, flow, span, made
        );
    }
    catch (const Foam::error& what)
    {
        OStringStream text;
        text<< "reactions in cell " << numbers_.cells[celli] << " at " << mesh_.cellCentres()[celli] << " m: "
            << what.message().c_str();
        throw solverFailure(CALCINE_FAILURE_DIVERGED, text.str());
    }
    forAll(made, k)
    {
        made[k] *= storage + flow.leaving[k]*held;
    }
    return reacts;
}


// Takes what the last solve left below zero out of what is made, in the cells that react and where it begins, the elements kept;
// whether there was any.
bool Foam::calcine::gas::keepPositive(const speciesTransport& transport)
{
    const PtrList<volScalarField>& Y = species_->Y();
    const fvScalarMatrix laplacian(fvm::laplacian(transport.diffusion, Y[0]));
    PtrList<fvScalarMatrix> matrices(1);
    matrices.set(0, speciesEquation(0, transport, laplacian).ptr());
    const scalarEquations equations(matrices, Y, matrices[0], Y[0]);
    // What the cells of other ranks give below zero, in kg/s.
    List<scalarField> foreign(Y.size(), scalarField(mesh_.nCells(), Zero));
    forAll(mesh_.boundary(), patchi)
    {
        const labelUList& cells = mesh_.boundary()[patchi].faceCells();
        if (boundary_.of(patchi) == passage::within)
        {
            forAll(Y, k)
            {
                const scalarField beyond(Y[k].boundaryField()[patchi].patchNeighbourField());
                forAll(cells, i)
                {
                    foreign[k][cells[i]] +=
                        matrices[0].boundaryCoeffs()[patchi][i]*min(beyond[i], scalar(0));
                }
            }
        }
    }
    scalarList inert(Y.size()), made(Y.size());
    bool any = false;
    forAll(mass_, celli)
    {
        bool below = false;
        forAll(Y, k)
        {
            // Fractions that transport itself leaves below zero stay.
            below |= Y[k].primitiveField()[celli] < 0 && speciesMade_[k][celli] < 0;
        }
        if (!below)
        {
            continue;
        }
        // What there would be without reactions, times the diagonal, in kg/s; what comes in below zero begins elsewhere.
        forAll(Y, k)
        {
            const scalar diagonal = equations.diagonal[0][celli]
              + given_.speciesCoefficient[k][celli] - given_.speciesCoefficient[0][celli];
            made[k] = speciesMade_[k][celli];
            inert[k] = diagonal*Y[k].primitiveField()[celli] - made[k] - foreign[k][celli];
        }
        for (const label facei : mesh_.cells()[celli])
        {
            if (facei < mesh_.nInternalFaces())
            {
                label other;
                const scalar weight = equations.weight(mesh_, celli, facei, other);
                forAll(Y, k)
                {
                    inert[k] += weight*min(Y[k].primitiveField()[other], scalar(0));
                }
            }
        }
        below = false;
        forAll(Y, k)
        {
            inert[k] = max(inert[k], scalar(0));
            below |= inert[k] + made[k] < 0;
        }
        if (!below)
        {
            continue;
        }
        any = true;
        reactions_->limitMade(inert, made);
        forAll(Y, k)
        {
            speciesMade_[k][celli] = made[k];
        }
    }
    setHeatMade();
    return returnReduce(any, orOp<bool>());
}


// Species and enthalpy once more to the linear tolerance, with what the last sweep has made. Transport stays that of one set of fields: by
// another diffusivity a cell that burns all that comes in would get less than it has burnt.
void Foam::calcine::gas::closeReactions(report& result)
{
    if (!reactions_)
    {
        return;
    }
    const speciesTransport transport(*this);
    for (label closing = 0; closing <= closings; ++closing)
    {
        solveSpecies(transport, result);
        solveEnthalpy(result);
        updateProperties();
        if (closing == closings || !keepPositive(transport))
        {
            break;
        }
    }
}
