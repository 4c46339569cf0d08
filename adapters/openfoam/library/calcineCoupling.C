#include "calcineCoupling.H"
#include "stockGas.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace functionObjects
{

defineTypeNameAndDebug(calcineCoupling, 0);
addToRunTimeSelectionTable(functionObject, calcineCoupling, dictionary);

} // End namespace functionObjects
} // End namespace Foam


Foam::functionObjects::calcineCoupling::calcineCoupling
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    functionObject(name),
    time_(runTime)
{}


bool Foam::functionObjects::calcineCoupling::execute()
{
    // At the end of a run it is asked once more; then the coordinator has gone.
    if (time_.value() < time_.endTime().value() - 0.5*time_.deltaTValue())
    {
        calcine::stockGas::New(time_.lookupObject<fvMesh>(polyMesh::defaultRegion)).stepped();
    }
    return true;
}
