#include "drawnIsotropy.H"
#include "AveragingMethod.H"
#include "mathematicalConstants.H"
#include "TimeScaleModel.H"

#include <cmath>
#include <vector>

namespace Foam
{
namespace calcine
{
    defineTypeNameAndDebug(drawnIsotropy, 0);
}
}

namespace
{

using namespace Foam;

typedef IsotropyModel<basicKinematicMPPICCloud::MPPICCloudType> isotropyModel;

isotropyModel::adddictionaryConstructorToTable<calcine::drawnIsotropy> addDrawnIsotropy_;

uint64_t mixed(uint64_t value)
{
    value = (value ^ (value >> 30))*0xbf58476d1ce4e5b9u;
    value = (value ^ (value >> 27))*0x94d049bb133111ebu;
    return value ^ (value >> 31);
}

// SplitMix64 (Steele, Lea and Flood 2014, doi 10.1145/2660193.2660195).
class draws
{
    uint64_t state_;

public:

    draws(uint64_t seed, uint64_t step, uint64_t row)
    :
        state_(mixed(mixed(mixed(seed) ^ step) ^ row))
    {}

    // Between 0 and 1, neither of them.
    scalar uniform()
    {
        state_ += 0x9e3779b97f4a7c15u;
        return (scalar(mixed(state_) >> 12) + 0.5)/scalar(uint64_t(1) << 52);
    }

    // Three independent numbers of standard normal distribution (Box and Muller).
    vector gaussian()
    {
        scalar numbers[4];
        for (int k = 0; k < 4; k += 2)
        {
            const scalar radius = std::sqrt(-2*std::log(uniform()));
            const scalar angle = constant::mathematical::twoPi*uniform();
            numbers[k] = radius*std::cos(angle);
            numbers[k + 1] = radius*std::sin(angle);
        }
        return vector(numbers[0], numbers[1], numbers[2]);
    }
};

// Sums over the parcels of each cell.
struct cellMotion
{
    scalarField mass, energy;
    vectorField mean;

    cellMotion(label cells, const basicKinematicMPPICCloud::MPPICCloudType& cloud)
    :
        mass(cells, Zero),
        energy(cells, Zero),
        mean(cells, Zero)
    {
        for (const basicKinematicMPPICCloud::parcelType& p : cloud)
        {
            const scalar m = p.nParticle()*p.mass();
            mass[p.cell()] += m;
            mean[p.cell()] += m*p.U();
        }
        forAll(mass, celli)
        {
            if (mass[celli] > 0)
            {
                mean[celli] /= mass[celli];
            }
        }
        for (const basicKinematicMPPICCloud::parcelType& p : cloud)
        {
            energy[p.cell()] += p.nParticle()*p.mass()*magSqr(p.U() - mean[p.cell()]);
        }
    }
};

} // End anonymous namespace


Foam::calcine::drawnIsotropy::drawnIsotropy(const dictionary& dict, cloudType& owner)
:
    IsotropyModel<cloudType>(dict, owner, typeName),
    pushed_(pushed::of(owner.mesh())),
    seed_(std::stoull(this->coeffDict().get<string>("seed")))
{}


void Foam::calcine::drawnIsotropy::calculate()
{
    cloudType& cloud = this->owner();
    const fvMesh& mesh = cloud.mesh();
    const scalar step = mesh.time().deltaTValue();
    const auto average = [&](const char* name) -> const AveragingMethod<scalar>&
    {
        return mesh.lookupObject<AveragingMethod<scalar>>(cloud.name() + ":" + name);
    };
    autoPtr<AveragingMethod<scalar>> rate
    (
        AveragingMethod<scalar>::New
        (
            IOobject(cloud.name() + ":isotropyRate", mesh.time().timeName(), mesh), cloud.solution().dict(), mesh
        )
    );
    *rate = this->timeScaleModel_->oneByTau
    (
        average("volumeAverage"), average("radiusAverage"), average("uSqrAverage"), average("frequencyAverage")
    )();

    const cellMotion before(mesh.nCells(), cloud);
    for (basicKinematicMPPICCloud::parcelType& p : cloud)
    {
        const label celli = p.cell();
        draws draw(seed_, pushed_.step, p.origId());
        const scalar kept = std::exp(-step*rate->interpolate(p.coordinates(), p.currentTetIndices()));
        if (before.energy[celli] > 0 && draw.uniform() >= kept)
        {
            const scalar deviation = std::sqrt(before.energy[celli]/(3*before.mass[celli]));
            p.U() = before.mean[celli] + deviation*draw.gaussian();
        }
    }
    const cellMotion after(mesh.nCells(), cloud);
    for (basicKinematicMPPICCloud::parcelType& p : cloud)
    {
        const label celli = p.cell();
        const scalar scale = after.energy[celli] > 0 ? std::sqrt(before.energy[celli]/after.energy[celli]) : 1;
        p.U() = before.mean[celli] + scale*(p.U() - after.mean[celli]);
    }
}
