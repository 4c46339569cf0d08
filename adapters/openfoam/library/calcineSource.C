#include "calcineSource.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace fv
{

defineTypeNameAndDebug(calcineSource, 0);
addToRunTimeSelectionTable(option, calcineSource, dictionary);

} // End namespace fv
} // End namespace Foam


Foam::fv::calcineSource::calcineSource
(
    const word& name,
    const word& modelType,
    const dictionary& dict,
    const fvMesh& mesh
)
:
    option(name, modelType, dict, mesh),
    gas_(calcine::stockGas::New(mesh))
{
    const auto& thermo = mesh.lookupObject<basicThermo>(basicThermo::dictName);
    fieldNames_ = wordList({"U", thermo.he().name()});
    applied_.setSize(fieldNames_.size(), false);
}
