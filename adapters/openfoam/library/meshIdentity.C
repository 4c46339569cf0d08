#include "meshIdentity.H"
#include "IFstream.H"
#include "Time.H"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
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

    uint64_t value() const
    {
        return hash_;
    }
};

// First words of what is hashed of a face.
const uint64_t ofPoints = 1, ofOwner = 2, ofNeighbour = 3;

uint64_t hashOf(uint64_t what, uint64_t face, uint64_t cell)
{
    fnv hash;
    hash.add(what);
    hash.add(face);
    hash.add(cell);
    return hash.value();
}

std::string digits(uint64_t value)
{
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

} // End anonymous namespace


std::string Foam::calcine::meshHash(const polyMesh& mesh, const addressing& numbers)
{
    uint64_t sum = 0;
    forAll(mesh.faces(), facei)
    {
        const uint64_t number = mag(numbers.faces[facei]) - 1;
        const uint64_t owner = numbers.cells[mesh.faceOwner()[facei]];
        // Of the two halves of a face between ranks one has its points, and each its own cell.
        if (numbers.faces[facei] < 0)
        {
            sum += hashOf(ofNeighbour, number, owner);
            continue;
        }
        fnv points;
        points.add(ofPoints);
        points.add(number);
        points.add(static_cast<uint64_t>(mesh.faces()[facei].size()));
        for (const label p : mesh.faces()[facei])
        {
            points.add(mesh.points()[p].x());
            points.add(mesh.points()[p].y());
            points.add(mesh.points()[p].z());
        }
        sum += points.value() + hashOf(ofOwner, number, owner);
        if (mesh.isInternalFace(facei))
        {
            const uint64_t neighbour = numbers.cells[mesh.faceNeighbour()[facei]];
            sum += hashOf(ofNeighbour, number, neighbour);
        }
    }
    // OpenFOAM's labels are too short for a sum of hashes: as texts.
    List<string> shares(Pstream::nProcs());
    shares[Pstream::myProcNo()] = digits(sum);
    Pstream::gatherList(shares);
    Pstream::scatterList(shares);
    uint64_t whole = 0;
    for (const string& share : shares)
    {
        whole += std::strtoull(share.c_str(), nullptr, 16);
    }
    return digits(whole);
}


void Foam::calcine::compareCells(const polyMesh& mesh, const addressing& numbers)
{
    const Time& time = mesh.time();
    IFstream file(time.rootPath()/time.globalCaseName()/time.constant()/"calcineCells");
    if (!file.good())
    {
        FatalErrorInFunction
            << "the file " << file.name() << " cannot be read" << exit(FatalError);
    }
    const scalarField volumes(file);
    const vectorField centres(file);
    if (volumes.size() != numbers.allCells || centres.size() != numbers.allCells)
    {
        FatalErrorInFunction
            << file.name() << " holds " << volumes.size() << " cells, the mesh "
            << numbers.allCells << exit(FatalError);
    }

    const scalar extent = mag(mesh.bounds().span()) + mag(mesh.bounds().midpoint());
    forAll(numbers.cells, celli)
    {
        const label number = numbers.cells[celli];
        const scalar size = cbrt(volumes[number]);
        const scalar tolerance = 1e-12*max(scalar(1), 1e-3*extent/size);
        const scalar volume = mesh.cellVolumes()[celli];
        const scalar shift = mag(mesh.cellCentres()[celli] - centres[number]);
        if
        (
            !(mag(volume - volumes[number]) <= tolerance*volumes[number])
         || !(shift <= tolerance*max(size, extent))
        )
        {
            FatalErrorInFunction
                << "cell " << number << " has a volume of " << volume
                << " m^3 in OpenFOAM and " << volumes[number] << " m^3 in Calcine, with centres "
                << shift << " m apart; a mesh with warped faces can be the reason"
                << exit(FatalError);
        }
    }
}
