#include "gasState.H"
#include "IFstream.H"
#include "Map.H"
#include "OFstream.H"
#include "OSspecific.H"
#include "Pstream.H"

namespace
{

using namespace Foam;

// First and last word of a file of state: a file cut short lacks the last.
const char* const firstWord = "calcineGasState5";
const char* const lastWord = "complete";

fileName stateFile(const fileName& directory, label rank)
{
    return directory/"calcineGasState." + Foam::name(rank);
}

// What one rank wrote.
struct part
{
    label ranks;
    labelList cells, faces;
    calcine::gasState state;

    part(const fileName& path, label species)
    {
        IFstream file(path, IOstream::BINARY);
        if (!file.good() || word(file) != firstWord)
        {
            FatalErrorInFunction
                << path << " is missing or no state of this version" << exit(FatalError);
        }
        ranks = readLabel(file);
        file>> cells >> faces;
        state.placed = readLabel(file) != 0;
        file>> state.mass >> state.enthalpy >> state.temperature >> state.density >> state.velocity
            >> state.pressure >> state.basePressure >> state.pressureGradient >> state.flux
            >> state.voidFraction;
        state.composition.setSize(readLabel(file));
        for (scalarField& fractions : state.composition)
        {
            file>> fractions;
        }
        if
        (
            word(file) != lastWord || state.voidFraction.size() != cells.size()
         || state.flux.size() != faces.size()
        )
        {
            FatalErrorInFunction << path << " is cut short" << exit(FatalError);
        }
        if (state.composition.size() != species)
        {
            FatalErrorInFunction
                << path << " holds " << state.composition.size() << " species, the gas " << species
                << exit(FatalError);
        }
    }
};

template<class Type>
void pick(Field<Type>& mine, label to, const Field<Type>& theirs, label from)
{
    mine[to] = theirs[from];
}

} // End anonymous namespace


void Foam::calcine::gasState::write
(
    const fileName& directory,
    const addressing& numbers
) const
{
    mkDir(directory);
    OFstream file(stateFile(directory, Pstream::myProcNo()), IOstream::BINARY);
    file<< word(firstWord) << nl << Pstream::nProcs() << nl
        << numbers.cells << nl << numbers.faces << nl << label(placed) << nl
        << mass << nl << enthalpy << nl << temperature << nl << density << nl << velocity << nl
        << pressure << nl << basePressure << nl << pressureGradient << nl << flux << nl
        << voidFraction << nl << composition.size() << nl;
    for (const scalarField& fractions : composition)
    {
        file<< fractions << nl;
    }
    file<< word(lastWord) << endl;
    if (!file.good())
    {
        FatalErrorInFunction
            << "the state could not be written to " << file.name() << exit(FatalError);
    }
}


void Foam::calcine::gasState::read
(
    const fileName& directory,
    const addressing& numbers,
    label species
)
{
    // As many ranks as those that wrote, and the same parts: only what this one wrote.
    const label own = Pstream::myProcNo();
    if (own == 0 || isFile(stateFile(directory, own)))
    {
        const part mine(stateFile(directory, own), species);
        if
        (
            mine.ranks == Pstream::nProcs() && mine.cells == numbers.cells
         && mine.faces == numbers.faces
        )
        {
            *this = mine.state;
            return;
        }
    }

    Map<label> cellOf(2*numbers.cells.size()), faceOf(2*numbers.faces.size());
    forAll(numbers.cells, celli)
    {
        cellOf.insert(numbers.cells[celli], celli);
    }
    forAll(numbers.faces, facei)
    {
        faceOf.insert(mag(numbers.faces[facei]), facei);
    }
    for (scalarField* values : {&mass, &enthalpy, &temperature, &density, &pressure, &voidFraction})
    {
        values->setSize(numbers.cells.size());
    }
    composition.setSize(species);
    for (scalarField& fractions : composition)
    {
        fractions.setSize(numbers.cells.size());
    }
    velocity.setSize(numbers.cells.size());
    pressureGradient.setSize(numbers.cells.size());
    flux.setSize(numbers.faces.size());

    label ranks = 1, found = 0, foundFaces = 0;
    for (label rank = 0; rank < ranks; ++rank)
    {
        const part theirs(stateFile(directory, rank), species);
        ranks = theirs.ranks;
        placed = theirs.state.placed;
        basePressure = theirs.state.basePressure;
        forAll(theirs.cells, from)
        {
            const auto to = cellOf.cfind(theirs.cells[from]);
            if (to.found())
            {
                ++found;
                pick(mass, *to, theirs.state.mass, from);
                pick(enthalpy, *to, theirs.state.enthalpy, from);
                pick(temperature, *to, theirs.state.temperature, from);
                pick(density, *to, theirs.state.density, from);
                forAll(composition, k)
                {
                    pick(composition[k], *to, theirs.state.composition[k], from);
                }
                pick(velocity, *to, theirs.state.velocity, from);
                pick(pressure, *to, theirs.state.pressure, from);
                pick(pressureGradient, *to, theirs.state.pressureGradient, from);
                pick(voidFraction, *to, theirs.state.voidFraction, from);
            }
        }
        forAll(theirs.faces, from)
        {
            const auto to = faceOf.cfind(mag(theirs.faces[from]));
            if (to.found())
            {
                ++foundFaces;
                const bool same = (theirs.faces[from] > 0) == (numbers.faces[*to] > 0);
                flux[*to] = same ? theirs.state.flux[from] : -theirs.state.flux[from];
            }
        }
    }
    // A face between ranks stands in two files.
    if (found != numbers.cells.size() || foundFaces < numbers.faces.size())
    {
        FatalErrorInFunction
            << directory << " holds " << found << " of the " << numbers.cells.size()
            << " cells and " << foundFaces << " of the " << numbers.faces.size()
            << " faces of this rank: it is of another mesh" << exit(FatalError);
    }
}
