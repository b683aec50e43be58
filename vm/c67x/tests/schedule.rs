//! The checker of schedules: valid code passes, deliberately invalid code does not.

use c67x::schedule::{Packet, Rule, check, packets};
use c67x::{Reg, Side, Unit, UnitKind, assemble};

const BASE: u32 = 0x8005_0000;

/// The packets of a text, one instruction per line.
fn code(text: &str) -> Vec<Packet> {
    let mut all: Vec<Packet> = Vec::new();
    let mut at = BASE;
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let line = assemble(line, at).unwrap_or_else(|error| panic!("{line}: {error}"));
        if line.joins_previous {
            all.last_mut().expect("a packet before").insts.push(line.inst);
        } else {
            all.push(Packet { insts: vec![line.inst] });
        }
        at += 4;
    }
    all
}

fn rules(text: &str) -> Vec<Rule> {
    // The code after it lets all results land, and returns.
    let text = format!("{text}\nNOP 9\nB .S2 B3\nNOP 5");
    check(BASE, &code(&text), &[BASE]).into_iter().map(|violation| violation.rule).collect()
}

fn unit(kind: UnitKind, side: Side) -> Unit {
    Unit { kind, side }
}

fn words(text: &str) -> Vec<u32> {
    text.split_whitespace().map(|word| u32::from_str_radix(word, 16).expect("a word")).collect()
}

#[test]
fn handwritten_loops_break_only_one_rule() {
    let sum =
        "0013E05B 02800029 01900058 030C3665 20000191 2003E05A 00006000 0298A078 000C0362 02140058 00006000";
    let dot = "02901059 011839A3 04800029 021088C2 0108205B 04000029 0280002B 0318C4F8 01000029 0300002B \
               001084FB 0018C4F8 01800029 0380002B 041084FA 00000000 04103765 00191701 60000010 03143766 \
               03103765 00191702 04143767 01004318 010BE05A 0200831A 0000A000 02105318 000C0362 00008000";
    let broken = |text| {
        let packets = packets(&words(text)).expect("instructions");
        check(BASE, &packets, &[BASE]).iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert!(broken(sum).is_empty());
    // Its count is decremented on .L2 in the cycle in which the previous iteration's sum is written there.
    assert_eq!(broken(dot), ["80050060: two results of .L2 are written in the same cycle"]);
}

#[test]
fn a_packet_uses_each_unit_and_path_once() {
    let l1 = unit(UnitKind::L, Side::A);
    assert_eq!(rules("ADD .L1 A1,A2,A3\n|| SUB .L1 A4,A5,A6"), [Rule::UnitTwice(l1), Rule::WritePort(l1)]);
    let same = "ADD .L1X A1,B2,A3\n|| ADD .S1X A4,B5,A6";
    assert_eq!(rules(same), [Rule::CrossPathTwice(Side::A)]);
    let paths = "LDW .D1T1 *A4,A5\n|| LDW .D2T1 *B4,A6";
    assert_eq!(rules(paths), [Rule::DataPathTwice(Side::A)]);
    let reads = "ADD .L1 A1,A1,A3\n|| ADD .S1 A1,A1,A4\n|| ADD .D1 A1,A5,A6";
    assert_eq!(rules(reads), [Rule::TooManyReads(Reg::a(1))]);
    assert_eq!(rules("NOP 2\n|| NOP 3"), [Rule::NopTwice]);
    assert_eq!(
        rules("LDW .D1T1 *A4[1],A5\n|| STW .D1T2 B5,*A4[1]")[0],
        Rule::UnitTwice(unit(UnitKind::D, Side::A))
    );
    assert!(rules("STW .D2T2 B15,*B15--[2]").contains(&Rule::StoresItsBase));
}

#[test]
fn long_operands_share_their_side() {
    let two = "ADD .L1 A4,A7:A6,A9:A8\n|| SHL .S1 A11:A10,1,A13:A12";
    assert_eq!(rules(two), [Rule::LongTwice(Side::A)]);
    let store = "SHL .S1 A11:A10,1,A13:A12\n|| STW .D1T1 A1,*A2";
    assert_eq!(rules(store), [Rule::LongWithStore(Side::A)]);
}

#[test]
fn two_results_in_one_cycle_are_found_unless_they_exclude_each_other() {
    let both = "MPYSP .M1 A1,A2,A3\nNOP 2\nADD .L1 A4,A5,A3";
    assert_eq!(rules(both), [Rule::TwoResults(Reg::a(3))]);
    assert_eq!(rules("[A1] ADD .L1 A4,A5,A3\n|| [!A1] ADD .S1 A4,A6,A3"), []);
    assert_eq!(rules("[A1] ADD .L1 A4,A5,A3\n|| [!A2] ADD .S1 A4,A6,A3"), [Rule::TwoResults(Reg::a(3))]);
}

#[test]
fn a_result_is_not_read_early_where_interrupts_are_taken() {
    assert_eq!(rules("LDW .D1T1 *A4,A5\nNOP 3\nADD .L1 A5,A6,A7"), [Rule::EarlyRead(Reg::a(5))]);
    assert_eq!(rules("LDW .D1T1 *A4,A5\nNOP 4\nADD .L1 A5,A6,A7"), []);
    // The interrupt is held off by the previous branch: the old value is certain.
    assert_eq!(rules("[A0] B .S1 pc+0\nLDW .D1T1 *A4,A5\nADD .L1 A5,A6,A7\nNOP 4\nNOP 4"), []);
    assert_eq!(rules("LDW .D1T1 *A4,A0\nNOP 2\n[A0] ADD .L1 A5,A6,A7"), [Rule::EarlyRead(Reg::a(0))]);
}

#[test]
fn doubles_may_arrive_just_in_time_but_not_during_a_read() {
    assert_eq!(rules("INTDP .L1 A1,A5:A4\nNOP 3\nADDDP .S1 A5:A4,A7:A6,A9:A8"), []);
    assert_eq!(rules("INTDP .L1 A1,A5:A4\nNOP 2\nADDDP .S1 A5:A4,A7:A6,A9:A8").len(), 2);
    let changed = "MPYDP .M1 A5:A4,A7:A6,A9:A8\nNOP 1\nMV .L1 A1,A5";
    assert_eq!(rules(changed), [Rule::ChangesDuringRead(Reg::a(5))]);
}

#[test]
fn units_stay_locked_and_have_one_write_port() {
    let l1 = unit(UnitKind::L, Side::A);
    let m1 = unit(UnitKind::M, Side::A);
    assert_eq!(rules("ADDDP .L1 A1:A0,A3:A2,A5:A4\nADD .L1 A6,A7,A8"), [Rule::UnitLocked(l1)]);
    assert_eq!(rules("ADDSP .L1 A1,A2,A3\nNOP 2\nADD .L1 A4,A5,A6"), [Rule::WritePort(l1)]);
    assert_eq!(rules("MPYDP .M1 A1:A0,A3:A2,A5:A4\nNOP 4\nMPYSP .M1 A6,A7,A8")[0], Rule::WritePort(m1));
    assert!(
        rules("MPYI .M1 A6,A7,A8\nNOP 4\nMPYDP .M1 A1:A0,A3:A2,A5:A4").contains(&Rule::LongMultiplies(m1))
    );
    let cross = "ADDDP .L1X A1:A0,B3:B2,A5:A4\nADD .S1X A6,B7,A8";
    assert_eq!(rules(cross), [Rule::CrossPathLocked(Side::A)]);
}

#[test]
fn branches_lead_to_packet_starts_with_nothing_in_flight() {
    let inside = "B .S1 pc+12\nNOP 5\nADD .L1 A1,A2,A3\n|| ADD .S1 A4,A5,A6";
    assert_eq!(rules(inside), [Rule::IntoPacket(BASE + 12)]);
    let late = "B .S2 B3\nNOP 4\nLDW .D1T1 *A4,A5";
    assert!(rules(late).contains(&Rule::InFlight(Reg::a(5))));
    assert_eq!(rules("[A1] B .S1 pc+0\n|| [A2] B .S2 B4"), [Rule::TwoBranches]);
    assert_eq!(check(BASE, &code("NOP"), &[BASE])[0].rule, Rule::RunsOut);
}

#[test]
fn a_loop_of_few_cycles_takes_no_interrupt() {
    // Five branches in flight, then a kernel of one cycle that never ends.
    let text = "B .S1 pc+20\nB .S1 pc+20\nB .S1 pc+20\nB .S1 pc+20\nB .S1 pc+20\nB .S1 pc+20";
    assert!(rules(text).contains(&Rule::NotInterruptible));
}

/// A loop of six cycles whose sum adds the value loaded in the previous iteration; its cycles 2, 3 and 5 are given.
fn overlapping([two, three, five]: [&str; 3]) -> Vec<Rule> {
    rules(&format!("[B0] B .S1 pc+0\n[B0] ADD .L2 -1,B0,B0\n{two}\n{three}\nLDW .D1T1 *A4++[1],A6\n{five}"))
}

#[test]
fn overlapping_iterations_are_checked_across_the_branch_back() {
    let sum = "ADD .L1 A5,A6,A5";
    assert_eq!(overlapping(["NOP 1", sum, "NOP 1"]), []);
    // The previous iteration's load lands a cycle later, and an interrupt could occur at the branch back.
    assert_eq!(overlapping([sum, "NOP 1", "NOP 1"]), [Rule::EarlyRead(Reg::a(6))]);
    assert_eq!(overlapping(["MV .L1 A7,A6", sum, "NOP 1"]), [Rule::TwoResults(Reg::a(6))]);
    let product = "MPYDP .M2 B5:B4,B7:B6,B9:B8";
    assert_eq!(overlapping(["NOP 1", sum, product]), []);
    assert_eq!(
        overlapping([product, sum, product]),
        [Rule::UnitLocked(unit(UnitKind::M, Side::B)), Rule::UnitLocked(unit(UnitKind::M, Side::B))]
    );
}

#[test]
fn packets_lie_inside_fetch_packets() {
    let text = "NOP\nNOP\nNOP\nNOP\nNOP\nNOP\nNOP\nADD .L1 A1,A2,A3\n|| ADD .S1 A4,A5,A6";
    assert_eq!(rules(text), [Rule::CrossesFetchPacket]);
}
