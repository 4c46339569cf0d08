#include "pushedForce.H"
#include "integrationScheme.H"

namespace Foam
{
namespace calcine
{
    defineTypeNameAndDebug(pushedForce, 0);
}
}

namespace
{
    typedef Foam::ParticleForce<Foam::basicKinematicMPPICCloud::kinematicCloudType> forceModel;

    forceModel::adddictionaryConstructorToTable<Foam::calcine::pushedForce> addPushedForce_;
}


Foam::calcine::pushedForce::pushedForce(cloudType& owner, const fvMesh& mesh, const dictionary& dict)
:
    ParticleForce<cloudType>(owner, mesh, dict, typeName, false),
    pushed_(pushed::of(mesh))
{}


Foam::forceSuSp Foam::calcine::pushedForce::calcCoupled
(
    const cloudType::parcelType& p,
    const cloudType::parcelType::trackingData& td,
    const scalar dt,
    const scalar mass,
    const scalar Re,
    const scalar muc
) const
{
    const label row = p.origId();
    const scalar coefficient = pushed_.coefficient[row];
    // The gas' velocity is the row's own, whatever the cloud takes from its field.
    const vector own = pushed_.force[row] + mass*pushed_.gravity;
    const vector acceleration = (coefficient*pushed_.gas[row] + own)/mass;
    const vector gained = owner().UIntegrator().delta(p.U(), dt, acceleration, coefficient/mass);
    pushed_.dragImpulse[row] += mass*gained - dt*own;
    return forceSuSp(own + coefficient*(pushed_.gas[row] - td.Uc()), coefficient);
}
