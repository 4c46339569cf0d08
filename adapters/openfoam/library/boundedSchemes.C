// Limited schemes of fvSchemes for scalars on irregular meshes; those of Calcine's native gas: `calcineVanLeer`, `calcineLimitedLinear K`.
//
// OpenFOAM's `vanLeer` and `limitedLinear` limit by r = a/D, D the difference across a face out of the cell C upstream, a = 2 grad(q)_C.d - D
// the one behind C: q_C less the value that the gradient leads to at the mirror image of the cell downstream. On irregular cells that value may
// lie beyond all that are there, and cells come to lie outside of what flows in. Here it is bounded by the least and the largest value of C
// and of what is beside it.
#include "coupledFvPatchFields.H"
#include "extrapolatedCalculatedFvPatchFields.H"
#include "fvcGrad.H"
#include "limitedSurfaceInterpolationScheme.H"
#include "surfaceFields.H"
#include "volFields.H"

// OpenFOAM's limiters include nothing of what they need.
#include "NVDTVD.H"
#include "limitedLinear.H"
#include "vanLeer.H"

namespace Foam
{

template<class Limiter>
class calcineBounded
:
    public limitedSurfaceInterpolationScheme<scalar>,
    public Limiter
{
    // Of a cell and what is beside it.
    struct range
    {
        scalar least, largest;
    };

    // Ranges of all cells as fields, which patches between ranks and periodic ones hand over.
    struct ranges
    {
        volScalarField least, largest;
    };

    ranges bounds(const volScalarField& field) const
    {
        const fvMesh& mesh = this->mesh();
        const auto made = [&](const char* name)
        {
            volScalarField values
            (
                IOobject(name + ('(' + field.name() + ')'), field.instance(), mesh, IOobject::NO_READ, IOobject::NO_WRITE, false),
                mesh,
                dimensionedScalar(field.dimensions(), Zero),
                extrapolatedCalculatedFvPatchScalarField::typeName
            );
            values.primitiveFieldRef() = field.primitiveField();
            return values;
        };
        ranges found{made("least"), made("largest")};
        const auto widen = [&](label celli, scalar value)
        {
            found.least[celli] = min(found.least[celli], value);
            found.largest[celli] = max(found.largest[celli], value);
        };
        for (label facei = 0; facei < mesh.nInternalFaces(); ++facei)
        {
            const label P = mesh.faceOwner()[facei], N = mesh.faceNeighbour()[facei];
            widen(P, field[N]);
            widen(N, field[P]);
        }
        forAll(mesh.boundary(), patchi)
        {
            const fvPatchScalarField& patch = field.boundaryField()[patchi];
            // A cell beside would lie as far behind a face of the boundary as this one does before it.
            const scalarField beside
            (
                patch.coupled() ? patch.patchNeighbourField() : 2*patch - patch.patchInternalField()
            );
            forAll(beside, i)
            {
                widen(patch.patch().faceCells()[i], beside[i]);
            }
        }
        found.least.correctBoundaryConditions();
        found.largest.correctBoundaryConditions();
        return found;
    }

    // The way d from P to N and the slope along it that the limiter sees as that of the cell upstream: (D + a)/2 of a bounded.
    scalar limited
    (
        scalar weight,
        scalar flux,
        scalar P,
        scalar N,
        const vector& gradientP,
        const vector& gradientN,
        const range& boundsP,
        const range& boundsN,
        const vector& d
    ) const
    {
        const bool forward = flux > 0;
        const scalar beyond = forward ? N - 2*(d & gradientP) : P + 2*(d & gradientN);
        const range& bounds = forward ? boundsP : boundsN;
        const scalar behind = max(bounds.least, min(bounds.largest, beyond));
        const scalar slope = forward ? (N - behind)/2 : (behind - P)/2;
        const vector gradient = d*(slope/magSqr(d));
        return Limiter::limiter(weight, flux, P, N, gradient, gradient, d);
    }

public:

    TypeName("calcineBounded");

    calcineBounded(const fvMesh& mesh, Istream& is)
    :
        limitedSurfaceInterpolationScheme<scalar>(mesh, is),
        Limiter(is)
    {}

    calcineBounded(const fvMesh& mesh, const surfaceScalarField& flux, Istream& is)
    :
        limitedSurfaceInterpolationScheme<scalar>(mesh, flux),
        Limiter(is)
    {}

    virtual tmp<surfaceScalarField> limiter(const volScalarField& field) const
    {
        const fvMesh& mesh = this->mesh();
        auto made = tmp<surfaceScalarField>::New
        (
            IOobject(this->type() + "Limiter(" + field.name() + ')', field.instance(), mesh, IOobject::NO_READ, IOobject::NO_WRITE, false),
            mesh,
            dimensionedScalar("one", dimless, 1)
        );
        surfaceScalarField& limits = made.ref();
        const auto kept = fvc::grad(field);
        const volVectorField& gradient = kept();
        const ranges bounds = this->bounds(field);
        const surfaceScalarField& weights = mesh.surfaceInterpolation::weights();
        const vectorField& centres = mesh.cellCentres();
        for (label facei = 0; facei < mesh.nInternalFaces(); ++facei)
        {
            const label P = mesh.faceOwner()[facei], N = mesh.faceNeighbour()[facei];
            limits[facei] = limited
            (
                weights[facei],
                this->faceFlux_[facei],
                field[P],
                field[N],
                gradient[P],
                gradient[N],
                {bounds.least[P], bounds.largest[P]},
                {bounds.least[N], bounds.largest[N]},
                centres[N] - centres[P]
            );
        }
        forAll(mesh.boundary(), patchi)
        {
            const fvPatch& patch = mesh.boundary()[patchi];
            if (!field.boundaryField()[patchi].coupled())
            {
                continue;
            }
            const auto beyond = [&](const auto& values) { return values.boundaryField()[patchi].patchNeighbourField(); };
            const scalarField N(beyond(field)), least(beyond(bounds.least)), largest(beyond(bounds.largest));
            const vectorField gradientN(beyond(gradient)), across(patch.delta());
            forAll(patch, i)
            {
                const label P = patch.faceCells()[i];
                limits.boundaryFieldRef()[patchi][i] = limited
                (
                    weights.boundaryField()[patchi][i],
                    this->faceFlux_.boundaryField()[patchi][i],
                    field[P],
                    N[i],
                    gradient[P],
                    gradientN[i],
                    {bounds.least[P], bounds.largest[P]},
                    {least[i], largest[i]},
                    across[i]
                );
            }
        }
        limits.setOriented();
        return made;
    }
};

#define makeCalcineBounded(NAME, LIMITER)                                                                        \
    typedef calcineBounded<LIMITER<NVDTVD>> NAME;                                                                \
    defineTemplateTypeNameAndDebugWithName(NAME, #NAME, 0);                                                      \
    surfaceInterpolationScheme<scalar>::addMeshConstructorToTable<NAME> addMesh##NAME;                           \
    surfaceInterpolationScheme<scalar>::addMeshFluxConstructorToTable<NAME> addMeshFlux##NAME;                   \
    limitedSurfaceInterpolationScheme<scalar>::addMeshConstructorToTable<NAME> addLimitedMesh##NAME;             \
    limitedSurfaceInterpolationScheme<scalar>::addMeshFluxConstructorToTable<NAME> addLimitedMeshFlux##NAME;

makeCalcineBounded(calcineVanLeer, vanLeerLimiter)
makeCalcineBounded(calcineLimitedLinear, limitedLinearLimiter)

} // End namespace Foam
