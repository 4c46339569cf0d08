#include "boundary.H"
#include "cyclicFvPatch.H"
#include "interpolateXY.H"
#include "processorFvPatch.H"

#include <sstream>

namespace
{

void readTable
(
    const Foam::dictionary& dict,
    const Foam::word& key,
    Foam::autoPtr<Foam::calcine::schedule>& table
)
{
    if (dict.found(key))
    {
        table.reset(new Foam::calcine::schedule(dict, key));
    }
}

} // End anonymous namespace


Foam::calcine::boundary::boundary
(
    const dictionary& patches,
    const volVectorField& velocity,
    const volScalarField& pressure
)
:
    mesh_(velocity.mesh()),
    driven_(patches.size()),
    passages_(mesh_.boundary().size(), passage::closed),
    closed_(true),
    massFlux_(mesh_.boundary().size(), Zero),
    drivesFlux_(mesh_.boundary().size(), false)
{
    boolList walls(mesh_.boundary().size(), false);
    label count = 0;
    for (const entry& item : patches)
    {
        driven_.set(count, new driven);
        driven& d = driven_[count++];
        d.patch = mesh_.boundaryMesh().findPatchID(item.keyword());
        if (d.patch < 0)
        {
            FatalIOErrorInFunction(patches)
                << "the mesh has no patch " << item.keyword() << "; it has "
                << mesh_.boundaryMesh().names() << exit(FatalIOError);
        }
        const dictionary& dict = item.dict();
        readTable(dict, "superficialVelocity", d.superficialVelocity);
        readTable(dict, "massFlow", d.massFlow);
        readTable(dict, "temperature", d.temperature);
        readTable(dict, "pressure", d.pressure);
        if (dict.found("along"))
        {
            const dictionary& along = dict.subDict("along");
            d.axis = along.get<vector>("axis");
            d.positions = along.get<scalarField>("positions");
            d.stations.setSize(d.positions.size());
            forAll(d.positions, i)
            {
                d.stations.set(i, new schedule(along, "station" + Foam::name(i)));
            }
        }
        if (dict.found("composition"))
        {
            const dictionary& composition = dict.subDict("composition");
            for (const entry& species : composition)
            {
                d.composition.set(species.keyword(), new schedule(composition, species.keyword()));
            }
        }
        d.opening = dict.found("pressureAt");
        d.at = dict.lookupOrDefault<vector>("pressureAt", Zero);
        d.byFlux = dict.lookupOrDefault<word>("scalars", "value") == "flux";
        readTable(dict, "heatFlux", d.heatFlux);
        readTable(dict, "coefficient", d.coefficient);
        readTable(dict, "ambient", d.ambient);
        walls[d.patch] = dict.lookupOrDefault<bool>("closed", false);
        if (d.coefficient.valid() != d.ambient.valid())
        {
            FatalIOErrorInFunction(dict)
                << "coefficient and ambient go together" << exit(FatalIOError);
        }
    }

    forAll(passages_, patchi)
    {
        const fvPatch& patch = mesh_.boundary()[patchi];
        if (isA<processorFvPatch>(patch) || isA<cyclicFvPatch>(patch))
        {
            passages_[patchi] = passage::within;
            continue;
        }
        if (patch.coupled())
        {
            FatalErrorInFunction
                << "the patch " << patch.name()
                << " is coupled (" << patch.type()
                << "), which this solver does not support" << exit(FatalError);
        }
        if (walls[patchi])
        {
            continue;
        }
        if (pressure.boundaryField()[patchi].fixesValue())
        {
            passages_[patchi] = passage::open;
            closed_ = false;
        }
        else if (velocity.boundaryField()[patchi].fixesValue())
        {
            passages_[patchi] = passage::given;
        }
    }
}


Foam::tmp<Foam::scalarField> Foam::calcine::boundary::driven::along
(
    const fvPatch& patch,
    scalar time
) const
{
    scalarField temperatures(stations.size());
    forAll(stations, i)
    {
        temperatures[i] = stations[i].at(time);
    }
    return tmp<scalarField>::New(interpolateXY(scalarField(patch.Cf() & axis), positions, temperatures));
}


void Foam::calcine::boundary::set(const std::string& lines, const wordList& species)
{
    std::istringstream all(lines);
    std::string line;
    while (std::getline(all, line))
    {
        std::istringstream words(line);
        std::string patch, condition, text;
        words >> patch >> condition;
        scalarList values;
        while (words >> text)
        {
            values.append(std::stod(text));
        }
        const label patchi = mesh_.boundaryMesh().findPatchID(patch);
        driven* found = nullptr;
        for (driven& d : driven_)
        {
            found = d.patch == patchi && patchi >= 0 ? &d : found;
        }
        const bool composition = condition == "composition";
        if (!found || values.size() != (composition ? species.size() : 1))
        {
            FatalErrorInFunction
                << "the condition \"" << line.c_str() << "\" cannot be set: the driven patches are of the mesh's "
                << mesh_.boundaryMesh().names() << ", and there are " << species.size() << " species"
                << exit(FatalError);
        }
        if (composition)
        {
            forAll(species, k)
            {
                found->composition.set(species[k], new schedule(values[k]));
            }
            continue;
        }
        if (condition == "superficial_velocity" || condition == "mass_flow")
        {
            found->superficialVelocity.clear();
            found->massFlow.clear();
        }
        autoPtr<schedule>* table =
            condition == "superficial_velocity" ? &found->superficialVelocity
          : condition == "mass_flow" ? &found->massFlow
          : condition == "temperature" ? &found->temperature
          : condition == "pressure" ? &found->pressure
          : condition == "heat_flux" ? &found->heatFlux
          : condition == "heat_transfer_coefficient" ? &found->coefficient
          : condition == "ambient" ? &found->ambient
          : nullptr;
        if (!table)
        {
            FatalErrorInFunction
                << "there is no condition \"" << condition.c_str() << "\" of a patch" << exit(FatalError);
        }
        table->reset(new schedule(values[0]));
    }
}


void Foam::calcine::boundary::updateState
(
    scalar time,
    scalar pRef,
    volScalarField& temperature,
    volScalarField& pressure
) const
{
    for (const driven& d : driven_)
    {
        if (d.temperature.valid() && !d.pressure.valid())
        {
            temperature.boundaryFieldRef()[d.patch] == d.temperature->at(time);
        }
        if (d.stations.size())
        {
            const fvPatch& patch = mesh_.boundary()[d.patch];
            temperature.boundaryFieldRef()[d.patch] == d.along(patch, time);
        }
        if (d.pressure.valid())
        {
            pressure.boundaryFieldRef()[d.patch] == d.pressure->at(time) - pRef;
        }
    }
}


void Foam::calcine::boundary::updateComposition
(
    scalar time,
    PtrList<volScalarField>& fractions
) const
{
    for (const driven& d : driven_)
    {
        for (volScalarField& Y : fractions)
        {
            if (d.composition.found(Y.name()) && !d.pressure.valid())
            {
                Y.boundaryFieldRef()[d.patch] == d.composition[Y.name()]->at(time);
            }
        }
    }
}


void Foam::calcine::boundary::updateVelocity
(
    scalar time,
    const scalarField& voidFraction,
    const volScalarField& density,
    volVectorField& velocity
)
{
    for (const driven& d : driven_)
    {
        const fvPatch& patch = mesh_.boundary()[d.patch];
        if (!(d.superficialVelocity.valid() || d.massFlow.valid()))
        {
            continue;
        }
        // Of all ranks; those that have none of the patch take part in the sum.
        const scalar area = gSum(patch.magSf());
        if (!patch.size())
        {
            continue;
        }
        const scalarField& rho = density.boundaryField()[d.patch];
        massFlux_[d.patch] = d.massFlow.valid()
          ? d.massFlow->at(time)/area
          : rho[0]*d.superficialVelocity->at(time);
        drivesFlux_[d.patch] = true;
        const scalarField pores(voidFraction, patch.faceCells());
        velocity.boundaryFieldRef()[d.patch] == -massFlux_[d.patch]/(rho*pores)*patch.nf();
    }
}


Foam::List<Foam::calcine::statedGas> Foam::calcine::boundary::stated
(
    scalar time,
    scalar pRef,
    const wordList& species
) const
{
    DynamicList<statedGas> all;
    for (const driven& d : driven_)
    {
        // Through a patch of a given pressure gas comes back in.
        const bool open = d.pressure.valid();
        if (!d.temperature.valid() || !(open || d.byFlux))
        {
            continue;
        }
        statedGas gas;
        gas.patch = d.patch;
        gas.open = open;
        gas.massFlux = massFlux_[d.patch];
        gas.opening = d.opening;
        gas.pressure = open ? d.pressure->at(time) - pRef : 0;
        gas.at = d.at;
        gas.temperature = d.temperature->at(time);
        gas.fractions.setSize(species.size());
        forAll(species, k)
        {
            gas.fractions[k] = d.composition[species[k]]->at(time);
        }
        all.append(gas);
    }
    return List<statedGas>(all);
}


Foam::scalar Foam::calcine::boundary::flow
(
    const fvPatch& patch,
    label i,
    const volScalarField& density,
    const volScalarField& voidFraction,
    const volVectorField& velocity
) const
{
    const label patchi = patch.index();
    if (drivesFlux_[patchi])
    {
        return -massFlux_[patchi]*patch.magSf()[i];
    }
    return density.boundaryField()[patchi][i]*voidFraction.boundaryField()[patchi][i]
       *(velocity.boundaryField()[patchi][i] & patch.Sf()[i]);
}


void Foam::calcine::boundary::addHeat
(
    scalar time,
    const volScalarField& conductivity,
    const scalarField& temperatureBase,
    const scalarField& heatCapacity,
    const scalarField& ownerDistance,
    fvScalarMatrix& enthalpy
) const
{
    for (const driven& d : driven_)
    {
        const fvPatch& patch = mesh_.boundary()[d.patch];
        scalarField& implicit = enthalpy.internalCoeffs()[d.patch];
        scalarField& given = enthalpy.boundaryCoeffs()[d.patch];
        forAll(patch, i)
        {
            const scalar area = patch.magSf()[i];
            if (d.heatFlux.valid())
            {
                given[i] += d.heatFlux->at(time)*area;
            }
            if (d.coefficient.valid() && d.coefficient->at(time) > 0)
            {
                // The half cell and the wall in series.
                const label celli = patch.faceCells()[i];
                const scalar half = ownerDistance[patch.start() + i]
                   /conductivity.boundaryField()[d.patch][i];
                const scalar k = area/(1/d.coefficient->at(time) + half);
                implicit[i] += k/heatCapacity[celli];
                given[i] += k*(d.ambient->at(time) - temperatureBase[celli]);
            }
        }
    }
}
