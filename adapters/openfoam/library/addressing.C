#include "addressing.H"
#include "labelIOList.H"
#include "PstreamReduceOps.H"

namespace
{

Foam::labelList readAddressing(const Foam::polyMesh& mesh, const Foam::word& name)
{
    return Foam::labelIOList
    (
        Foam::IOobject
        (
            name,
            mesh.facesInstance(),
            mesh.meshSubDir,
            mesh,
            Foam::IOobject::MUST_READ,
            Foam::IOobject::NO_WRITE,
            false
        )
    );
}

} // End anonymous namespace


Foam::calcine::addressing::addressing(const polyMesh& mesh)
:
    cells(identity(mesh.nCells())),
    faces(identity(mesh.nFaces())),
    allCells(returnReduce(mesh.nCells(), sumOp<label>()))
{
    for (label& face : faces)
    {
        ++face;
    }
    if (Pstream::parRun())
    {
        cells = readAddressing(mesh, "cellProcAddressing");
        faces = readAddressing(mesh, "faceProcAddressing");
    }
    if (cells.size() != mesh.nCells() || faces.size() != mesh.nFaces())
    {
        FatalErrorInFunction
            << "the addressing of this rank is for " << cells.size() << " cells and "
            << faces.size() << " faces, its mesh has " << mesh.nCells() << " and "
            << mesh.nFaces() << exit(FatalError);
    }
}


Foam::label Foam::calcine::addressing::local(label cell) const
{
    return cells.find(cell);
}
