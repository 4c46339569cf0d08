#include "calcineEpsilonWallFunction.H"
#include "addToRunTimeSelectionTable.H"
#include "fvMatrix.H"
#include "turbulenceModel.H"
#include "volFields.H"

namespace Foam
{
namespace calcine
{

makePatchTypeField(fvPatchScalarField, calcineEpsilonWallFunction);

} // End namespace calcine
} // End namespace Foam


Foam::calcine::calcineEpsilonWallFunction::calcineEpsilonWallFunction
(
    const fvPatch& patch,
    const DimensionedField<scalar, volMesh>& field
)
:
    epsilonWallFunctionFvPatchScalarField(patch, field),
    maxSolidFraction_(1)
{}


Foam::calcine::calcineEpsilonWallFunction::calcineEpsilonWallFunction
(
    const fvPatch& patch,
    const DimensionedField<scalar, volMesh>& field,
    const dictionary& dict
)
:
    epsilonWallFunctionFvPatchScalarField(patch, field, dict),
    maxSolidFraction_(dict.get<scalar>("maxSolidFraction"))
{}


Foam::calcine::calcineEpsilonWallFunction::calcineEpsilonWallFunction
(
    const calcineEpsilonWallFunction& other,
    const fvPatch& patch,
    const DimensionedField<scalar, volMesh>& field,
    const fvPatchFieldMapper& mapper
)
:
    epsilonWallFunctionFvPatchScalarField(other, patch, field, mapper),
    maxSolidFraction_(other.maxSolidFraction_)
{}


Foam::calcine::calcineEpsilonWallFunction::calcineEpsilonWallFunction
(
    const calcineEpsilonWallFunction& other
)
:
    epsilonWallFunctionFvPatchScalarField(other),
    maxSolidFraction_(other.maxSolidFraction_)
{}


Foam::calcine::calcineEpsilonWallFunction::calcineEpsilonWallFunction
(
    const calcineEpsilonWallFunction& other,
    const DimensionedField<scalar, volMesh>& field
)
:
    epsilonWallFunctionFvPatchScalarField(other, field),
    maxSolidFraction_(other.maxSolidFraction_)
{}


Foam::labelList Foam::calcine::calcineEpsilonWallFunction::inBed() const
{
    const auto& voidFraction = db().lookupObject<volScalarField>("voidFraction");
    const labelUList& cells = patch().faceCells();
    DynamicList<label> faces(cells.size());
    forAll(cells, facei)
    {
        if (1 - voidFraction[cells[facei]] > maxSolidFraction_)
        {
            faces.append(facei);
        }
    }
    return labelList(std::move(faces));
}


void Foam::calcine::calcineEpsilonWallFunction::updateCoeffs()
{
    if (updated())
    {
        return;
    }
    typedef DimensionedField<scalar, volMesh> cells;
    const auto& model = db().lookupObject<turbulenceModel>(turbulenceModel::propertiesName);
    cells& G = db().lookupObjectRef<cells>(model.GName());
    cells& epsilon = const_cast<cells&>(internalField());
    const scalarField ownG(G, patch().faceCells());
    const scalarField ownEpsilon(epsilon, patch().faceCells());
    epsilonWallFunctionFvPatchScalarField::updateCoeffs();
    scalarField& values = *this;
    for (const label facei : inBed())
    {
        const label celli = patch().faceCells()[facei];
        G[celli] = ownG[facei];
        epsilon[celli] = ownEpsilon[facei];
        values[facei] = ownEpsilon[facei];
    }
}


void Foam::calcine::calcineEpsilonWallFunction::manipulateMatrix(fvMatrix<scalar>& matrix)
{
    scalarField outside(size(), 1.0);
    for (const label facei : inBed())
    {
        outside[facei] = 0;
    }
    epsilonWallFunctionFvPatchScalarField::manipulateMatrix(matrix, outside);
}


Foam::tmp<Foam::Field<Foam::scalar>>
Foam::calcine::calcineEpsilonWallFunction::gradientInternalCoeffs() const
{
    auto coefficients = epsilonWallFunctionFvPatchScalarField::gradientInternalCoeffs();
    for (const label facei : inBed())
    {
        coefficients.ref()[facei] = 0;
    }
    return coefficients;
}


Foam::tmp<Foam::Field<Foam::scalar>>
Foam::calcine::calcineEpsilonWallFunction::gradientBoundaryCoeffs() const
{
    auto coefficients = epsilonWallFunctionFvPatchScalarField::gradientBoundaryCoeffs();
    for (const label facei : inBed())
    {
        coefficients.ref()[facei] = 0;
    }
    return coefficients;
}


void Foam::calcine::calcineEpsilonWallFunction::write(Ostream& stream) const
{
    epsilonWallFunctionFvPatchScalarField::write(stream);
    stream.writeEntry("maxSolidFraction", maxSolidFraction_);
}
