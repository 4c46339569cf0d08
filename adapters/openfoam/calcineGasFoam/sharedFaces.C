#include "sharedFaces.H"
#include "cyclicPolyPatch.H"
#include "processorPolyPatch.H"

Foam::calcine::sharedFaces::sharedFaces(const polyMesh& mesh)
:
    mesh_(mesh),
    shared_(mesh.nFaces() - mesh.nInternalFaces(), false),
    foreign_(shared_.size(), false)
{
    for (const polyPatch& patch : mesh.boundaryMesh())
    {
        const bool known = isA<processorPolyPatch>(patch) || isA<cyclicPolyPatch>(patch);
        if (const auto* between = known ? isA<coupledPolyPatch>(patch) : nullptr)
        {
            forAll(patch, i)
            {
                const label boundaryFace = patch.start() + i - mesh.nInternalFaces();
                shared_[boundaryFace] = true;
                foreign_[boundaryFace] = !between->owner();
            }
        }
    }
}


Foam::vectorField Foam::calcine::sharedFaces::pointsBeyond(const vectorField& cells) const
{
    vectorField values(mesh_.nFaces(), Zero);
    for (label facei = 0; facei < mesh_.nInternalFaces(); ++facei)
    {
        values[facei] = cells[mesh_.faceNeighbour()[facei]];
    }
    List<point> others;
    syncTools::swapBoundaryCellPositions(mesh_, cells, others);
    forAll(others, i)
    {
        values[mesh_.nInternalFaces() + i] = others[i];
    }
    return values;
}


void Foam::calcine::sharedFaces::swap(scalarField& faces) const
{
    SubList<scalar> ofBoundary(faces, shared_.size(), mesh_.nInternalFaces());
    syncTools::swapBoundaryFaceList(mesh_, ofBoundary);
}


void Foam::calcine::sharedFaces::agree(scalarField& flux) const
{
    scalarField other(flux);
    swap(other);
    forAll(foreign_, i)
    {
        if (foreign_[i])
        {
            const label facei = mesh_.nInternalFaces() + i;
            flux[facei] = -other[facei];
        }
    }
}
