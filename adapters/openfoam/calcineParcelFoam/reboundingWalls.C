#include "reboundingWalls.H"

namespace Foam
{
namespace calcine
{
    defineTypeNameAndDebug(reboundingWalls, 0);
}
}

namespace
{
    typedef Foam::PatchInteractionModel<Foam::basicKinematicMPPICCloud::kinematicCloudType> wallModel;

    wallModel::adddictionaryConstructorToTable<Foam::calcine::reboundingWalls> addReboundingWalls_;
}


Foam::calcine::reboundingWalls::reboundingWalls(const dictionary& dict, cloudType& owner)
:
    PatchInteractionModel<cloudType>(dict, owner, typeName),
    pushed_(pushed::of(owner.mesh())),
    restitution_(owner.mesh().boundary().size()),
    friction_(restitution_.size())
{
    const dictionary& patches = this->coeffDict().subDict("patches");
    forAll(restitution_, patchi)
    {
        const polyPatch& patch = owner.mesh().boundaryMesh()[patchi];
        if (!patch.coupled())
        {
            const dictionary& own = patches.subDict(patch.name());
            own.readEntry("restitution", restitution_[patchi]);
            own.readEntry("friction", friction_[patchi]);
        }
    }
}


bool Foam::calcine::reboundingWalls::correct
(
    cloudType::parcelType& p,
    const polyPatch& pp,
    bool& keepParticle
)
{
    // Periodic planes, which the cloud crosses itself.
    if (pp.coupled())
    {
        return false;
    }
    keepParticle = true;
    const vector normal = p.normal();
    vector& velocity = p.U();
    if (pushed_.at != pushed::stage::flight)
    {
        velocity -= max(velocity & normal, scalar(0))*normal;
        return true;
    }
    vector wall = owner().U().boundaryField()[pp.index()][pp.whichFace(p.face())];
    wall -= (wall & normal)*normal;
    const vector slip = velocity - wall;
    const scalar towards = slip & normal;
    if (towards <= 0)
    {
        return true;
    }
    const scalar change = (1 + restitution_[pp.index()][p.typeId()])*towards;
    const vector along = slip - towards*normal;
    const scalar speed = mag(along);
    const scalar lost = min(friction_[pp.index()][p.typeId()]*change, speed);
    vector lostVelocity = change*normal;
    if (speed > 0)
    {
        lostVelocity += (lost/speed)*along;
    }
    velocity -= lostVelocity;
    pushed_.support -= p.nParticle()*p.mass()*lostVelocity;
    return true;
}
