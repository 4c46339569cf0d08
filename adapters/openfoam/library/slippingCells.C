#include "slippingCells.H"
#include "basicSymmetryFvPatchFields.H"
#include "syncTools.H"
#include "wedgeFvPatchFields.H"

namespace
{

using namespace Foam;

// |sum n|^2 up to which faces count as opposite ones.
const scalar opposite = 0.1;

// |sum n|^2 of each cell.
scalarField oneSided(const volVectorField& velocity)
{
    const fvMesh& mesh = velocity.mesh();
    vectorField slipping(mesh.nCells(), Zero), open(mesh.nCells(), Zero);
    for (const fvPatchVectorField& patch : velocity.boundaryField())
    {
        if (patch.coupled() || patch.fixesValue())
        {
            continue;
        }
        vectorField& sum = calcine::slips(patch) ? slipping : open;
        const vectorField normals(patch.patch().nf());
        forAll(normals, i)
        {
            sum[patch.patch().faceCells()[i]] += normals[i];
        }
    }
    scalarField squares(mesh.nCells(), Zero);
    forAll(squares, celli)
    {
        if (magSqr(slipping[celli]) > opposite)
        {
            squares[celli] = magSqr(slipping[celli] + open[celli]);
        }
    }
    return squares;
}

} // End anonymous namespace


bool Foam::calcine::slips(const fvPatchVectorField& velocity)
{
    return isA<basicSymmetryFvPatchVectorField>(velocity) || isA<wedgeFvPatchVectorField>(velocity);
}


void Foam::calcine::mixBeside
(
    const volVectorField& velocity,
    scalar everywhere,
    scalar more,
    tensorField& gradient
)
{
    // Patches and their conditions are the same on all ranks.
    bool any = everywhere > 0;
    for (const fvPatchVectorField& patch : velocity.boundaryField())
    {
        any = any || slips(patch);
    }
    if (!any)
    {
        return;
    }
    const fvMesh& mesh = velocity.mesh();
    const scalarField share(min(everywhere + more*oneSided(velocity), scalar(1)));
    tensorField sum(mesh.nCells(), Zero);
    scalarField count(mesh.nCells(), Zero);
    const auto add = [&](label celli, const tensor& beside)
    {
        if (share[celli] > 0)
        {
            sum[celli] += beside;
            count[celli] += 1;
        }
    };
    for (label facei = 0; facei < mesh.nInternalFaces(); ++facei)
    {
        const label P = mesh.faceOwner()[facei], N = mesh.faceNeighbour()[facei];
        add(P, gradient[N]);
        add(N, gradient[P]);
    }
    List<tensor> beyond;
    syncTools::swapBoundaryCellList(mesh, gradient, beyond);
    for (const fvPatchVectorField& patch : velocity.boundaryField())
    {
        if (patch.coupled())
        {
            const fvPatch& faces = patch.patch();
            forAll(faces, i)
            {
                add(faces.faceCells()[i], beyond[faces.start() + i - mesh.nInternalFaces()]);
            }
        }
    }
    forAll(gradient, celli)
    {
        if (count[celli] > 0)
        {
            gradient[celli] = (1 - share[celli])*gradient[celli] + (share[celli]/count[celli])*sum[celli];
        }
    }
}
