#include "meshIdentity.H"
#include "IFstream.H"
#include "Time.H"

#include <cstdint>
#include <cstdio>
#include <cstring>

namespace
{

class fnv
{
    uint64_t hash_ = 0xcbf29ce484222325u;

public:

    void add(uint64_t word)
    {
        for (int byte = 0; byte < 8; ++byte)
        {
            hash_ = (hash_ ^ (word & 0xff))*0x100000001b3u;
            word >>= 8;
        }
    }

    void add(double value)
    {
        const double positiveZero = value + 0.0;
        uint64_t word;
        std::memcpy(&word, &positiveZero, sizeof word);
        add(word);
    }

    std::string text() const
    {
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash_));
        return digits;
    }
};

} // End anonymous namespace


std::string Foam::calcine::meshHash(const polyMesh& mesh)
{
    fnv hash;
    for (const point& p : mesh.points())
    {
        hash.add(p.x());
        hash.add(p.y());
        hash.add(p.z());
    }
    for (const face& f : mesh.faces())
    {
        hash.add(static_cast<uint64_t>(f.size()));
        for (const label p : f)
        {
            hash.add(static_cast<uint64_t>(p));
        }
    }
    for (const label cell : mesh.faceOwner())
    {
        hash.add(static_cast<uint64_t>(cell));
    }
    for (const label cell : mesh.faceNeighbour())
    {
        hash.add(static_cast<uint64_t>(cell));
    }
    return hash.text();
}


void Foam::calcine::compareCells(const polyMesh& mesh)
{
    IFstream file(mesh.time().constantPath()/"calcineCells");
    if (!file.good())
    {
        FatalErrorInFunction
            << "the file " << file.name() << " cannot be read" << exit(FatalError);
    }
    const scalarField volumes(file);
    const vectorField centres(file);
    if (volumes.size() != mesh.nCells() || centres.size() != mesh.nCells())
    {
        FatalErrorInFunction
            << file.name() << " holds " << volumes.size() << " cells, the mesh "
            << mesh.nCells() << exit(FatalError);
    }

    const scalar extent = mag(mesh.bounds().span()) + mag(mesh.bounds().midpoint());
    forAll(volumes, celli)
    {
        const scalar size = cbrt(volumes[celli]);
        const scalar tolerance = 1e-12*max(scalar(1), 1e-3*extent/size);
        const scalar volume = mesh.cellVolumes()[celli];
        const scalar shift = mag(mesh.cellCentres()[celli] - centres[celli]);
        if
        (
            !(mag(volume - volumes[celli]) <= tolerance*volumes[celli])
         || !(shift <= tolerance*max(size, extent))
        )
        {
            FatalErrorInFunction
                << "cell " << celli << " has a volume of " << volume
                << " m^3 in OpenFOAM and " << volumes[celli] << " m^3 in Calcine, with centres "
                << shift << " m apart; a mesh with warped faces can be the reason"
                << exit(FatalError);
        }
    }
}
