#include "pushed.H"

namespace Foam
{
namespace calcine
{
    defineTypeNameAndDebug(pushed, 0);
}
}


Foam::calcine::pushed::pushed(const fvMesh& mesh, const vector& g)
:
    regIOobject
    (
        IOobject(typeName, mesh.time().constant(), mesh, IOobject::NO_READ, IOobject::NO_WRITE)
    ),
    gravity(g)
{}


Foam::calcine::pushed& Foam::calcine::pushed::of(const fvMesh& mesh)
{
    return mesh.lookupObjectRef<pushed>(typeName);
}


void Foam::calcine::pushed::resize(label rows)
{
    force.setSize(rows);
    gas.setSize(rows);
    dragImpulse.setSize(rows);
    coefficient.setSize(rows);
    force = Zero;
    gas = Zero;
    dragImpulse = Zero;
    coefficient = 0;
}
