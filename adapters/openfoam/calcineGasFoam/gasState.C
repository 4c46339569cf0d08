#include "gasState.H"
#include "IFstream.H"
#include "OFstream.H"
#include "OSspecific.H"

namespace
{

// First and last word of a file of state: a file cut short lacks the last.
const char* const firstWord = "calcineGasState3";
const char* const lastWord = "complete";

Foam::fileName stateFile(const Foam::fileName& directory)
{
    return directory/"calcineGasState";
}

} // End anonymous namespace


void Foam::calcine::gasState::write(const fileName& directory) const
{
    mkDir(directory);
    OFstream file(stateFile(directory), IOstream::BINARY);
    file<< word(firstWord) << nl << label(placed) << nl
        << mass << nl << enthalpy << nl << temperature << nl << velocity << nl
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


void Foam::calcine::gasState::read(const fileName& directory, label cells, label faces, label species)
{
    IFstream file(stateFile(directory), IOstream::BINARY);
    if (!file.good() || word(file) != firstWord)
    {
        FatalErrorInFunction
            << file.name() << " is missing or no state of this version" << exit(FatalError);
    }
    placed = readLabel(file) != 0;
    file>> mass >> enthalpy >> temperature >> velocity >> pressure >> basePressure
        >> pressureGradient >> flux >> voidFraction;
    const label found = readLabel(file);
    if (found != species)
    {
        FatalErrorInFunction
            << file.name() << " holds " << found << " species, the gas " << species
            << exit(FatalError);
    }
    composition.setSize(found);
    for (scalarField& fractions : composition)
    {
        file>> fractions;
    }
    if (word(file) != lastWord || mass.size() != cells || flux.size() != faces)
    {
        FatalErrorInFunction
            << file.name() << " holds " << mass.size() << " cells and " << flux.size()
            << " faces, the mesh " << cells << " and " << faces << ", or is cut short"
            << exit(FatalError);
    }
}
