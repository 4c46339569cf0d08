// Schemes of fvSchemes for meshes where lines between centres are oblique to faces or miss their centres; those of Calcine's native gas.
//
// `calcineLeastSquares`: the gradient g of a cell minimises sum (d.g - D)^2/d^2 over what is beside it, d the way there from its centre, D the
// difference. On the boundary a given value counts at the centre of the face; where only the slope along the normal is known, zero, the
// patch's value counts at the foot of the normal. Exact for linear fields on any mesh. Of a velocity, cells at faces along which gas slips take half of |sum n|^2 of
// the mean of the gradients of the cells beside them (slippingCells.H).
//
// `calcineCorrected`: the slope along the normal of a face, over-relaxed,
//
//   (q_N - q_P - t_P.g_P - t_N.g_N)/(d_P + d_N),
//
// t the parts along the face of the ways from the owner's centre to the face's and on to the neighbour's, d those along the normal; on the
// boundary where a value is given, with P's half alone.
//
// `calcineLinear`: linear interpolation to the centre of the face, beyond that to where the line between the centres meets it by the gradients
// of fvSchemes on both sides. OpenFOAM's `skewCorrected linear` takes Gauss' gradients, which are not exact for linear fields on tetrahedra.
#include "obliqueSchemes.H"
#include "slippingCells.H"
#include "emptyPolyPatch.H"
#include "extrapolatedCalculatedFvPatchField.H"
#include "gaussGrad.H"
#include "gradScheme.H"
#include "linear.H"
#include "skewCorrectionVectors.H"
#include "snGradScheme.H"
#include "surfaceFields.H"
#include "volFields.H"

namespace
{

using namespace Foam;

// Share of the gradients beside a cell at faces along which gas slips, times |sum n|^2.
const scalar beside = 0.5;

void mixGradients(const volVectorField& field, volTensorField& gradient)
{
    calcine::mixBeside(field, 0, beside, gradient.primitiveFieldRef());
}


void mixGradients(const volScalarField&, volVectorField&)
{}

} // End anonymous namespace


namespace Foam
{
namespace fv
{

template<class Type>
class calcineGrad
:
    public gradScheme<Type>
{
public:

    TypeName("calcineLeastSquares");

    calcineGrad(const fvMesh& mesh, Istream&)
    :
        gradScheme<Type>(mesh)
    {}

    virtual tmp<GeometricField<typename outerProduct<vector, Type>::type, fvPatchField, volMesh>> calcGrad
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const word& name
    ) const;
};


template<class Type>
class calcineSnGrad
:
    public snGradScheme<Type>
{
public:

    TypeName("calcineCorrected");

    calcineSnGrad(const fvMesh& mesh, Istream&)
    :
        snGradScheme<Type>(mesh)
    {}

    virtual tmp<surfaceScalarField> deltaCoeffs(const GeometricField<Type, fvPatchField, volMesh>&) const
    {
        return this->mesh().nonOrthDeltaCoeffs();
    }

    virtual bool corrected() const
    {
        return true;
    }

    virtual tmp<GeometricField<Type, fvsPatchField, surfaceMesh>> correction
    (
        const GeometricField<Type, fvPatchField, volMesh>& field
    ) const;
};


// The gradient of a field as fvSchemes has it.
template<class Type>
tmp<GeometricField<typename outerProduct<vector, Type>::type, fvPatchField, volMesh>> gradientOf
(
    const GeometricField<Type, fvPatchField, volMesh>& field
)
{
    const word name("grad(" + field.name() + ')');
    const fvMesh& mesh = field.mesh();
    return gradScheme<Type>::New(mesh, mesh.gradScheme(name))().grad(field, name);
}


template<class Type>
tmp<GeometricField<typename outerProduct<vector, Type>::type, fvPatchField, volMesh>>
calcineGrad<Type>::calcGrad
(
    const GeometricField<Type, fvPatchField, volMesh>& field,
    const word& name
) const
{
    typedef typename outerProduct<vector, Type>::type GradType;
    const fvMesh& mesh = field.mesh();
    auto made = tmp<GeometricField<GradType, fvPatchField, volMesh>>::New
    (
        IOobject(name, field.instance(), mesh, IOobject::NO_READ, IOobject::NO_WRITE),
        mesh,
        dimensioned<GradType>(field.dimensions()/dimLength, Zero),
        extrapolatedCalculatedFvPatchField<GradType>::typeName
    );
    auto& gradient = made.ref();
    tensorField ways(mesh.nCells(), Zero);
    const vectorField& centres = mesh.cellCentres();
    const auto add = [&](label celli, const vector& way, const Type& difference)
    {
        const vector weighted = way/magSqr(way);
        ways[celli] += weighted*way;
        gradient[celli] += weighted*difference;
    };
    for (label facei = 0; facei < mesh.nInternalFaces(); ++facei)
    {
        const label P = mesh.faceOwner()[facei], N = mesh.faceNeighbour()[facei];
        const vector way = centres[N] - centres[P];
        const Type difference = field[N] - field[P];
        add(P, way, difference);
        add(N, -way, -difference);
    }
    forAll(mesh.boundary(), patchi)
    {
        const fvPatch& patch = mesh.boundary()[patchi];
        const fvPatchField<Type>& values = field.boundaryField()[patchi];
        const vectorField across(patch.delta());
        if (values.coupled())
        {
            const Field<Type> beyond(values.patchNeighbourField());
            forAll(patch, i)
            {
                const label P = patch.faceCells()[i];
                add(P, across[i], beyond[i] - field[P]);
            }
            continue;
        }
        const bool given = values.fixesValue();
        forAll(patch, i)
        {
            const label P = patch.faceCells()[i];
            const vector along = patch.Cf()[i] - centres[P] - across[i];
            const vector way = given ? vector(across[i] + calcine::limitedSkew(along, mag(across[i]))) : across[i];
            add(P, way, values[i] - field[P]);
        }
    }
    // Nothing varies across empty patches, whose faces have no field.
    for (const polyPatch& patch : mesh.boundaryMesh())
    {
        if (isA<emptyPolyPatch>(patch))
        {
            forAll(patch, i)
            {
                const vector n = normalised(mesh.faceAreas()[patch.start() + i]);
                ways[patch.faceCells()[i]] += n*n;
            }
        }
    }
    forAll(ways, celli)
    {
        gradient[celli] = inv(ways[celli]) & gradient[celli];
    }
    mixGradients(field, gradient);
    gradient.correctBoundaryConditions();
    gaussGrad<Type>::correctBoundaryConditions(field, gradient);
    forAll(mesh.boundary(), patchi)
    {
        const fvPatch& patch = mesh.boundary()[patchi];
        const fvPatchField<Type>& values = field.boundaryField()[patchi];
        if (values.coupled() || !values.fixesValue())
        {
            continue;
        }
        const vectorField across(patch.delta()), n(patch.nf());
        auto& atFace = gradient.boundaryFieldRef()[patchi];
        forAll(patch, i)
        {
            const label P = patch.faceCells()[i];
            const scalar distance = n[i] & across[i];
            const vector along = calcine::limitedSkew(patch.Cf()[i] - centres[P] - across[i], distance);
            const Type slope = (values[i] - field[P] - (along & gradient[P]))/distance;
            atFace[i] = gradient[P] + n[i]*(slope - (n[i] & gradient[P]));
        }
    }
    return made;
}


template<class Type>
tmp<GeometricField<Type, fvsPatchField, surfaceMesh>> calcineSnGrad<Type>::correction
(
    const GeometricField<Type, fvPatchField, volMesh>& field
) const
{
    typedef typename outerProduct<vector, Type>::type GradType;
    const fvMesh& mesh = this->mesh();
    const auto kept = gradientOf(field);
    const GeometricField<GradType, fvPatchField, volMesh>& gradient = kept();
    auto made = tmp<GeometricField<Type, fvsPatchField, surfaceMesh>>::New
    (
        IOobject("snGradCorr(" + field.name() + ')', field.instance(), mesh, IOobject::NO_READ, IOobject::NO_WRITE),
        mesh,
        dimensioned<Type>(field.dimensions()/dimLength, Zero)
    );
    auto& corrections = made.ref();
    corrections.setOriented();
    const surfaceScalarField& perDistance = mesh.nonOrthDeltaCoeffs();
    const vectorField& centres = mesh.cellCentres();
    // The part of a way along a face, limited.
    const auto along = [](const vector& way, const vector& n)
    {
        const scalar distance = n & way;
        return calcine::limitedSkew(way - distance*n, distance);
    };
    for (label facei = 0; facei < mesh.nInternalFaces(); ++facei)
    {
        const label P = mesh.faceOwner()[facei], N = mesh.faceNeighbour()[facei];
        const vector n = normalised(mesh.faceAreas()[facei]);
        const vector& middle = mesh.faceCentres()[facei];
        const Type beyond =
            (along(middle - centres[P], n) & gradient[P]) + (along(centres[N] - middle, n) & gradient[N]);
        corrections[facei] = -beyond*perDistance[facei];
    }
    forAll(mesh.boundary(), patchi)
    {
        const fvPatch& patch = mesh.boundary()[patchi];
        const fvPatchField<Type>& values = field.boundaryField()[patchi];
        const vectorField across(patch.delta()), n(patch.nf());
        auto& atFaces = corrections.boundaryFieldRef()[patchi];
        if (values.coupled())
        {
            const Field<GradType> other(gradient.boundaryField()[patchi].patchNeighbourField());
            forAll(patch, i)
            {
                const vector toFace = patch.Cf()[i] - centres[patch.faceCells()[i]];
                const Type beyond =
                    (along(toFace, n[i]) & gradient[patch.faceCells()[i]])
                  + (along(across[i] - toFace, n[i]) & other[i]);
                atFaces[i] = -beyond*perDistance.boundaryField()[patchi][i];
            }
        }
        else if (values.fixesValue())
        {
            forAll(patch, i)
            {
                const label P = patch.faceCells()[i];
                const vector toFace = patch.Cf()[i] - centres[P];
                atFaces[i] = -(along(toFace, n[i]) & gradient[P])*patch.deltaCoeffs()[i];
            }
        }
    }
    return made;
}

} // End namespace fv


template<class Type>
class calcineLinear
:
    public surfaceInterpolationScheme<Type>
{
public:

    TypeName("calcineLinear");

    calcineLinear(const fvMesh& mesh, Istream&)
    :
        surfaceInterpolationScheme<Type>(mesh)
    {}

    calcineLinear(const fvMesh& mesh, const surfaceScalarField&, Istream&)
    :
        surfaceInterpolationScheme<Type>(mesh)
    {}

    tmp<surfaceScalarField> weights(const GeometricField<Type, fvPatchField, volMesh>&) const
    {
        return this->mesh().surfaceInterpolation::weights();
    }

    virtual bool corrected() const
    {
        return skewCorrectionVectors::New(this->mesh()).skew();
    }

    virtual tmp<GeometricField<Type, fvsPatchField, surfaceMesh>> correction
    (
        const GeometricField<Type, fvPatchField, volMesh>& field
    ) const
    {
        const fvMesh& mesh = this->mesh();
        typedef typename outerProduct<vector, Type>::type GradType;
        // OpenFOAM has these ways without their dimension.
        const auto ways = dimensionedScalar("m", dimLength, 1)*skewCorrectionVectors::New(mesh)();
        return ways & linear<GradType>(mesh).interpolate(fv::gradientOf(field));
    }
};

makeSurfaceInterpolationTypeScheme(calcineLinear, scalar)
makeSurfaceInterpolationTypeScheme(calcineLinear, vector)

} // End namespace Foam

makeFvGradTypeScheme(calcineGrad, scalar)
makeFvGradTypeScheme(calcineGrad, vector)
makeSnGradTypeScheme(calcineSnGrad, scalar)
makeSnGradTypeScheme(calcineSnGrad, vector)
