#include "parcels.H"
#include "IFstream.H"
#include "OFstream.H"
#include "OSspecific.H"
#include "Time.H"

namespace
{

// First and last word of a file of state: a file cut short lacks the last.
const char* const firstWord = "calcineParcels1";
const char* const lastWord = "complete";

} // End anonymous namespace


Foam::calcine::parcelRows Foam::calcine::parcelRows::ofCase(const Time& time)
{
    IFstream file(time.path()/time.constant()/"calcineParcelRows");
    if (!file.good())
    {
        FatalErrorInFunction << "the file " << file.name() << " cannot be read" << exit(FatalError);
    }
    parcelRows rows;
    file>> rows.id >> rows.population >> rows.position >> rows.velocity >> rows.diameter >> rows.density
        >> rows.weight;
    return rows;
}


void Foam::calcine::parcelRows::read(const fileName& directory)
{
    const fileName path = directory/"calcineParcels";
    IFstream file(path, IOstream::BINARY);
    if (!file.good() || word(file) != firstWord)
    {
        FatalErrorInFunction
            << path << " is missing or no state of this version" << exit(FatalError);
    }
    step = readLabel(file);
    file>> id >> population >> velocity >> diameter >> density >> weight >> coordinates >> cell >> tetFace
        >> tetPoint >> face;
    if (word(file) != lastWord || face.size() != id.size())
    {
        FatalErrorInFunction << path << " is cut short" << exit(FatalError);
    }
}


void Foam::calcine::parcelRows::write(const fileName& directory) const
{
    mkDir(directory);
    OFstream file(directory/"calcineParcels", IOstream::BINARY);
    file<< word(firstWord) << nl << step << nl << id << nl << population << nl << velocity << nl << diameter << nl
        << density << nl << weight << nl << coordinates << nl << cell << nl << tetFace << nl << tetPoint << nl
        << face << nl << word(lastWord) << endl;
    if (!file.good())
    {
        FatalErrorInFunction
            << "the state could not be written to " << file.name() << exit(FatalError);
    }
}
