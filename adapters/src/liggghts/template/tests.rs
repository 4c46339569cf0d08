//! What a script of the user's own may say.

use super::*;

const SCRIPT: &str = "units si\natom_style granular\nread_data ${calcine_data} # beds\n\
    timestep ${calcine_step}\ninclude calcine.motion\n";

fn refused(more: &str) -> String {
    told(&check(&commands(&format!("{SCRIPT}{more}"))))
}

#[test]
fn what_calcine_does_itself_is_refused_with_the_line() {
    assert_eq!(check(&commands(SCRIPT)), []);
    for (more, part) in [
        ("run 1000", "line 6, `run 1000`: Calcine advances"),
        ("\n  clear", "line 7, `clear`"),
        ("units cgs", "units si"),
        ("atom_style sph", "spheres"),
        ("create_atoms 1 single 0 0 0", "particles.place"),
        ("read_data particles.data", "once"),
        (
            "fix ins all &\n insert/rate/region seed 1",
            "line 6, `fix ins all  insert/rate/region",
        ),
        ("fix own all external pf/array 1", "leave the line out"),
        ("run_style respa 2 2", "at each step"),
        ("include other.in", "calcine.walls"),
        (
            "if \"1 > 0\" then \"run 500\"",
            "commands within others cannot be looked at",
        ),
    ] {
        assert!(refused(more).contains(part), "{}", refused(more));
    }
}

#[test]
fn what_every_script_needs_is_named_with_its_line() {
    for (left_out, part) in [
        ("units si\n", "write `units si`"),
        (
            "read_data ${calcine_data} # beds\n",
            "write `read_data ${calcine_data}`",
        ),
        (
            "timestep ${calcine_step}\n",
            "write `timestep ${calcine_step}`",
        ),
        (
            "include calcine.motion\n",
            "there is no `fix … nve/sphere`; write `include calcine.motion`",
        ),
    ] {
        let found = told(&check(&commands(&SCRIPT.replace(left_out, ""))));
        assert!(found.contains(part), "{found}");
    }
}

fn template(more: &str) -> ScriptTemplate {
    ScriptTemplate {
        path: "in.bed".into(),
        commands: commands(&format!("{SCRIPT}{more}")),
        populations: vec!["small beads".into()],
        materials: Vec::new(),
    }
}

#[test]
fn time_step_and_gravity_are_those_of_the_case() {
    let down = Vec3::new(0.0, 0.0, -9.81);
    let variables = [("calcine_step".to_owned(), "1e-5".to_owned())];
    assert_eq!(template("").check_step(&variables, 1e-5), Ok(()));
    let other = template("timestep 2e-5").check_step(&variables, 1e-5);
    assert!(
        other
            .unwrap_err()
            .to_string()
            .contains("motion.motion_step")
    );
    for fine in [
        "include calcine.gravity",
        "fix g all gravity 9.81 vector 0 0 -1",
        "fix g all gravity 9.81 vector 0 0 -2",
    ] {
        assert_eq!(
            template(fine).check_gravity(&variables, down),
            Ok(()),
            "{fine}"
        );
    }
    for (wrong, part) in [
        ("", "include calcine.gravity"),
        ("fix g all gravity 9.8 vector 0 0 -1", "(0 0 -9.81) m/s²"),
        ("fix g all gravity 9.81 chute 24", "vector X Y Z"),
        ("fix g all gravity v_g vector 0 0 -1", "numbers"),
    ] {
        let error = template(wrong).check_gravity(&variables, down).unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
    }
    assert_eq!(
        template("").check_gravity(&variables, Vec3::zeros()),
        Ok(())
    );
}

#[test]
fn a_fixed_side_drops_what_is_to_be_taken_out() {
    let none = Periodicity::default();
    let check = |more: &str| template(more).check_boundary(&none, LostParticles::TakeOut);
    assert!(check("boundary m s m").is_ok());
    assert!(check("boundary ${calcine_boundary}").is_ok());
    for fixed in ["boundary f m m", "boundary m m mf"] {
        let told = check(fixed).err().map(|error| error.to_string());
        let told = told.unwrap_or_default();
        assert!(
            told.contains("drops what leaves a fixed side"),
            "{fixed}: {told}"
        );
        assert!(told.contains("write `boundary m m m`"), "{fixed}: {told}");
    }
}

#[test]
fn the_sides_of_the_box_repeat_themselves_where_the_case_does() {
    let span = Some(PeriodicSpan {
        low: 0.0,
        high: 1.0,
    });
    let along_x = Periodicity {
        axes: [span, None, None],
    };
    let check = |more: &str, periodicity: &Periodicity| {
        let found = template(more).check_boundary(periodicity, LostParticles::End);
        found
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default()
    };
    let none = Periodicity::default();
    for fine in [
        "boundary f f f",
        "boundary s fm m",
        "boundary ${calcine_boundary}",
    ] {
        assert_eq!(check(fine, &none), "", "{fine}");
    }
    assert_eq!(check("boundary p f f", &along_x), "");
    assert_eq!(check("boundary ${calcine_boundary}", &along_x), "");
    for (wrong, periodicity, part) in [
        (
            "boundary p f f",
            &none,
            "line 6, `boundary p f f`: the case has no periodic patches",
        ),
        (
            "boundary f f f",
            &along_x,
            "is periodic along x alone; write `boundary p f f`",
        ),
        ("boundary p p f", &along_x, "is periodic along x alone"),
        (
            "boundary p",
            &along_x,
            "write `boundary p f f`, or `boundary ${calcine_boundary}`",
        ),
        (
            "",
            &none,
            "there is no `boundary`; write `boundary ${calcine_boundary}`",
        ),
    ] {
        let found = check(wrong, periodicity);
        assert!(found.contains(part), "{found}");
    }
    let all = Periodicity { axes: [span; 3] };
    assert_eq!(check("", &all), "");
}

#[test]
fn all_that_is_wrong_with_a_script_is_told_at_once_in_the_order_of_its_lines() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("in.bed");
    let text = "units cgs\natom_style granular\ncreate_atoms 1 single 0 0 0\nfix m all mesh/surface file funnel.stl type 1\nrun 5\n";
    fs::write(&path, text).unwrap();
    let error = ScriptTemplate::read(&path, Vec::new(), Vec::new()).unwrap_err();
    let found: Vec<String> = error.findings().iter().map(ToString::to_string).collect();
    let parts = [
        "line 1, `units cgs`: Calcine is SI",
        "line 3, `create_atoms",
        "there is no file funnel.stl beside the script",
        "line 5, `run 5`",
        "there is no `read_data`",
        "there is no `timestep`",
        "there is no `fix … nve/sphere`",
    ];
    assert_eq!(found.len(), parts.len(), "{found:?}");
    for (found, part) in found.iter().zip(parts) {
        assert!(found.contains(part), "{found}");
    }
}

#[test]
fn files_of_a_script_are_relative_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let stl = folder.path().join("funnel.stl");
    fs::write(&stl, "").unwrap();
    let mut commands = commands(
        "fix m all mesh/surface file funnel.stl type 1\nfix p all print 10 text file x.txt",
    );
    assert_eq!(beside(folder.path(), &mut commands), []);
    let expected = format!("fix m all mesh/surface file {} type 1", stl.display());
    assert_eq!(commands[0].text, expected);
    assert!(commands[1].text.contains("file x.txt"));
}

#[test]
fn names_become_words_of_a_variable() {
    assert_eq!(word("small beads-2"), "small_beads_2");
}
