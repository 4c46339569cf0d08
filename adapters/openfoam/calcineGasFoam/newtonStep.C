#include "newtonStep.H"

#include <cmath>

namespace
{

// Share of its first residual to which the step is solved, and iterations at most; a solve that does not come there is used if it came nearer.
const Foam::scalar relative = 1e-4;
const Foam::label iterations = 60;
// A step is not followed to less than this share of a temperature, or to a fraction further below zero than this.
const Foam::scalar leastTemperature = 0.5;
const Foam::scalar leastFraction = -1e-3;

// Diagonal and right side of an equation with its boundaries, those to other ranks with the values at hand.
void gather
(
    const Foam::fvScalarMatrix& matrix,
    const Foam::volScalarField& psi,
    Foam::scalarField& diagonal,
    Foam::scalarField& source
)
{
    using namespace Foam;
    diagonal = matrix.diag();
    source = matrix.source();
    forAll(psi.boundaryField(), patchi)
    {
        const fvPatchScalarField& patch = psi.boundaryField()[patchi];
        const labelUList& cells = patch.patch().faceCells();
        const scalarField& own = matrix.internalCoeffs()[patchi];
        const scalarField& given = matrix.boundaryCoeffs()[patchi];
        const scalarField beyond
        (
            patch.coupled() ? patch.patchNeighbourField()() : scalarField(patch.size(), scalar(1))
        );
        forAll(cells, i)
        {
            diagonal[cells[i]] += own[i];
            source[cells[i]] += given[i]*beyond[i];
        }
    }
}

} // End anonymous namespace


Foam::calcine::gas::scalarEquations::scalarEquations
(
    const PtrList<fvScalarMatrix>& matrices,
    const PtrList<volScalarField>& Y,
    const fvScalarMatrix& heat,
    const volScalarField& h
)
:
    diagonal(matrices.size() + 1),
    source(matrices.size() + 1),
    species(matrices[0]),
    enthalpy(heat)
{
    forAll(matrices, k)
    {
        gather(matrices[k], Y[k], diagonal[k], source[k]);
    }
    gather(heat, h, diagonal.last(), source.last());
}


Foam::scalar Foam::calcine::gas::scalarEquations::weight
(
    const fvMesh& mesh,
    label celli,
    label facei,
    label& other
) const
{
    if (mesh.faceOwner()[facei] == celli)
    {
        other = mesh.faceNeighbour()[facei];
        return species.upper()[facei];
    }
    other = mesh.faceOwner()[facei];
    return species.lower()[facei];
}


Foam::scalar Foam::calcine::gas::scalarEquations::heatWeight
(
    const fvMesh& mesh,
    label celli,
    label facei
) const
{
    return mesh.faceOwner()[facei] == celli ? enthalpy.upper()[facei] : enthalpy.lower()[facei];
}


void Foam::calcine::gas::scalarEquations::enter
(
    const fvMesh& mesh,
    label celli,
    const PtrList<volScalarField>& Y,
    const volScalarField& h,
    scalarList& given
) const
{
    forAll(given, value)
    {
        given[value] = source[value][celli];
    }
    for (const label facei : mesh.cells()[celli])
    {
        if (facei < mesh.nInternalFaces())
        {
            label other;
            const scalar share = weight(mesh, celli, facei, other);
            forAll(Y, k)
            {
                given[k] -= share*Y[k].primitiveField()[other];
            }
            given.last() -= heatWeight(mesh, celli, facei)*h.primitiveField()[other];
        }
    }
}


Foam::calcine::gas::newtonStep::newtonStep
(
    const fvMesh& mesh,
    const scalarEquations& equations,
    const labelList& order,
    scalar unit,
    const List<cellRun>& runs
)
:
    mesh(mesh),
    equations(equations),
    order(order),
    unit(unit),
    width(equations.diagonal.size()),
    runs(runs),
    visited(mesh.nCells()*width)
{}


void Foam::calcine::gas::newtonStep::note(label celli, const scalarList& inert)
{
    forAll(inert, value)
    {
        visited[celli*width + value] = inert[value];
    }
}


void Foam::calcine::gas::newtonStep::neighbours
(
    label celli,
    const scalarField& x,
    scalarList& out
) const
{
    const label heat = width - 1;
    out = Zero;
    for (const label facei : mesh.cells()[celli])
    {
        if (facei < mesh.nInternalFaces())
        {
            label other;
            const scalar share = equations.weight(mesh, celli, facei, other);
            for (label k = 0; k < heat; ++k)
            {
                out[k] -= share*x[other*width + k];
            }
            out[heat] -= equations.heatWeight(mesh, celli, facei)*x[other*width + heat];
        }
    }
    forAll(out, value)
    {
        out[value] /= equations.diagonal[value][celli];
    }
}


void Foam::calcine::gas::newtonStep::respond
(
    label celli,
    const scalarList& x,
    scalarList& out
) const
{
    const scalarSquareMatrix& response = runs[celli].response;
    if (response.empty())
    {
        out = x;
        return;
    }
    forAll(out, i)
    {
        out[i] = 0;
        forAll(x, j)
        {
            out[i] += response(i, j)*x[j];
        }
    }
}


void Foam::calcine::gas::newtonStep::times(const scalarField& x, scalarField& out) const
{
    scalarList given(width), reached(width);
    for (label celli = 0; celli < mesh.nCells(); ++celli)
    {
        neighbours(celli, x, given);
        respond(celli, given, reached);
        forAll(reached, value)
        {
            out[celli*width + value] = x[celli*width + value] - reached[value];
        }
    }
}


void Foam::calcine::gas::newtonStep::precondition(const scalarField& right, scalarField& x) const
{
    x = Zero;
    scalarList given(width), reached(width);
    for (label place = 0; place < 2*order.size(); ++place)
    {
        const bool forth = place < order.size();
        const label celli = order[forth ? place : 2*order.size() - 1 - place];
        neighbours(celli, x, given);
        respond(celli, given, reached);
        forAll(reached, value)
        {
            x[celli*width + value] = right[celli*width + value] + reached[value];
        }
    }
}


bool Foam::calcine::gas::newtonStep::solve(const scalarField& right, scalarField& x) const
{
    const scalar first = sqrt(sumSqr(right));
    if (!(first > 0 && first < GREAT))
    {
        return false;
    }
    x = Zero;
    scalarField r(right), p(right), v(r.size()), t(r.size()), y(r.size()), z(r.size());
    scalar rho = sumProd(right, r);
    for (label iteration = 0; iteration < iterations; ++iteration)
    {
        precondition(p, y);
        times(y, v);
        const scalar alpha = rho/sumProd(right, v);
        r -= alpha*v;
        x += alpha*y;
        if (sqrt(sumSqr(r)) <= relative*first)
        {
            break;
        }
        precondition(r, z);
        times(z, t);
        const scalar omega = sumProd(t, r)/sumSqr(t);
        x += omega*z;
        r -= omega*t;
        if (sqrt(sumSqr(r)) <= relative*first)
        {
            break;
        }
        const scalar next = sumProd(right, r);
        const scalar beta = next/rho*alpha/omega;
        rho = next;
        if (!std::isfinite(beta))
        {
            return false;
        }
        p = r + beta*(p - omega*v);
    }
    return sqrt(sumSqr(r)) < first && std::isfinite(sum(x));
}


void Foam::calcine::gas::newtonStep::correct
(
    PtrList<volScalarField>& Y,
    volScalarField& h,
    const gasMixture& mixture,
    const scalarField& T
) const
{
    const label species = width - 1;
    scalarField right(visited.size()), step(visited.size());
    scalarList given(width), change(width);
    for (label celli = 0; celli < mesh.nCells(); ++celli)
    {
        equations.enter(mesh, celli, Y, h, given);
        forAll(given, value)
        {
            given[value] =
                given[value]/equations.diagonal[value][celli] - visited[celli*width + value];
        }
        given[species] /= unit;
        respond(celli, given, change);
        forAll(change, value)
        {
            right[celli*width + value] = change[value];
        }
    }
    if (!solve(right, step))
    {
        return;
    }
    scalarList fractions(species);
    for (label celli = 0; celli < mesh.nCells(); ++celli)
    {
        forAll(fractions, k)
        {
            fractions[k] = Y[k].primitiveField()[celli] + step[celli*width + k];
        }
        if (!(min(fractions) >= leastFraction))
        {
            continue;
        }
        for (scalar& y : fractions)
        {
            y = max(y, scalar(0));
        }
        const scalar enthalpy = h.primitiveField()[celli] + step[celli*width + species]*unit;
        if (mixture.temperature(enthalpy, fractions, T[celli]) > leastTemperature*T[celli])
        {
            forAll(fractions, k)
            {
                Y[k].primitiveFieldRef()[celli] = fractions[k];
            }
            h.primitiveFieldRef()[celli] = enthalpy;
        }
    }
}
