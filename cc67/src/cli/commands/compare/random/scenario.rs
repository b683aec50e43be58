//! A scenario: actions on a board, in parts that can be removed one by one.

use crate::record::SAMPLES;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// The kind of a part: the place where it is executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PartKind {
    /// A line sent by the PC; `(run S)` lets S seconds pass.
    Line,
    /// A declaration outside the functions of the program in thread 1.
    Head,
    /// A statement before recording begins.
    Start,
    /// A statement in the servo interrupt, before the values are recorded.
    Tick,
    /// A statement in a slice of a thread's program.
    Slice { thread: u8, slice: u32 },
}

/// A part of a scenario: a line or a statement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) kind: PartKind,
    pub(super) text: String,
}

/// The times at which a program records the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RecordTimes {
    /// Never; only its output is compared.
    Printed,
    /// In every n-th slice.
    Slices(u32),
    /// In every servo interrupt, beginning with slice [`FIRST_TICK`].
    Ticks,
}

/// The slice in which recording in the servo interrupt begins.
const FIRST_TICK: u32 = 2;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Scenario {
    /// Its name, consisting of area and seed.
    pub(super) name: String,
    pub(super) parts: Vec<Part>,
    /// The number of slices of the programs; 0 for lines sent by the PC.
    pub(super) slices: u32,
    pub(super) observed: RecordTimes,
    /// C expressions that are recorded.
    pub(super) columns: Vec<String>,
}

/// The declarations of every recording program; `tests/board/measured` describes a program's memory.
const HEAD: &str = "\
int *g; double *r; int m; double *cs; double T0_; int dk_; int cbn; int k_;
void *memcpy(void*,void*,int);
void dcb_(void){ if(dk_==0){ memcpy(g,chan,3456); dk_=1; } }
void dump(void){ int k; dk_=0; WaitNextTimeSlice(); UserCallBack=dcb_; while(dk_==0); UserCallBack=0;
 for(k=0;k<8;k++) g[2900+k]=chan[k].pcoeff ? 1+(int)(chan[k].pcoeff-chan[k].c) : 0;
 cs=(double*)(g+2784); cs[0]=CS0_t; cs[1]=CS0_TimeExecuted; cs[2]=CS0_TimeBase; cs[3]=CS0_TimeBaseDesired; cs[4]=CS0_TimeBaseDelta; cs[5]=CS0_TimeDownloaded; cs[6]=CS0_TimeLost; cs[7]=CS0_LastFRO; cs[8]=CS0_LastRapidFRO; cs[9]=CS0_DecelTime; cs[10]=CS0_NomDecel2TB2; cs[11]=CS0_StoppingState; cs[12]=CS0_Flushed; cs[13]=CS0_DoingRapid; cs[14]=(CoordSystem0!=0)?1+(CoordSystem0-ParametricCoeffs):0; cs[15]=(LastCoordSystem0!=0)?1+(LastCoordSystem0-ParametricCoeffs):0; cs[16]=ParametricIndex; cs[17]=ParametricIndexWrapped; cs[18]=KLP; cs[19]=TauKLP; cs[20]=VirtualBits; cs[21]=CheckDoneBuf(); cs[22]=CheckDoneXYZABC(); for(k=0;k<8;k++) cs[23+k]=CheckDone(k); cs[31]=VirtualBitsEx[0];
}
";

impl Scenario {
    /// Returns whether the PC sends lines to a board without programs.
    pub(super) fn is_session(&self) -> bool {
        self.slices == 0
    }

    fn at(&self, kind: PartKind) -> impl Iterator<Item = &str> {
        self.parts.iter().filter(move |part| part.kind == kind).map(|part| part.text.as_str())
    }

    /// The lines sent by the PC.
    pub(super) fn lines(&self) -> impl Iterator<Item = &str> {
        self.at(PartKind::Line)
    }

    /// The programs by their threads; the program of thread 1 starts automatically.
    pub(super) fn programs(&self) -> Vec<(u8, String)> {
        if self.is_session() {
            return Vec::new();
        }
        let threads: BTreeSet<u8> = self.parts.iter().filter_map(Part::thread).chain([1]).collect();
        let text = |thread| if thread == 1 { self.main() } else { self.other(thread) };
        threads.into_iter().map(|thread| (thread, text(thread))).collect()
    }

    /// The number of samples in a run.
    pub(super) fn samples(&self) -> usize {
        (match self.observed {
            RecordTimes::Printed => 0,
            RecordTimes::Slices(every) => self.slices.div_ceil(every),
            // Two ticks per slice, less than the actual number at the end.
            RecordTimes::Ticks => 2 * self.slices.saturating_sub(FIRST_TICK + 2),
        }) as usize
    }

    /// The number of slices, or of ticks, between two samples.
    pub(super) fn samples_every(&self) -> usize {
        match self.observed {
            RecordTimes::Printed | RecordTimes::Ticks => 1,
            RecordTimes::Slices(every) => every as usize,
        }
    }

    /// The statements in the slices of a thread.
    fn slices_of(&self, thread: u8) -> String {
        let mut text = String::new();
        let mut slices: Vec<(u32, &str)> = self
            .parts
            .iter()
            .filter_map(|part| match part.kind {
                PartKind::Slice { thread: other, slice } if other == thread => Some((slice, &*part.text)),
                _ => None,
            })
            .collect();
        slices.sort_by_key(|(slice, _)| *slice);
        for (slice, statement) in slices {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "   if(n=={slice}){{ {statement} }}");
        }
        text
    }

    fn main(&self) -> String {
        let head: String = self.at(PartKind::Head).flat_map(|text| [text, "\n"]).collect();
        let start: String = self.at(PartKind::Start).flat_map(|text| [" ", text, "\n"]).collect();
        let slices = self.slices_of(1);
        let count = self.slices;
        if self.observed == RecordTimes::Printed {
            return format!(
                "{head}int main(){{ int n;\n{start} for(n=0;n<{count};n++){{\n   WaitNextTimeSlice();\n{slices} }}\n persist.UserData[0]=1;\n return 0;\n}}\n"
            );
        }
        let words = SAMPLES as usize + 2 * self.samples() * self.columns.len();
        let (every, sample) = match self.observed {
            RecordTimes::Slices(every) => {
                (every, self.columns.iter().map(|column| format!(" r[m++]={column};")).collect())
            }
            RecordTimes::Ticks | RecordTimes::Printed => (1, String::new()),
        };
        let (call_back, set, reset) = if self.observed == RecordTimes::Ticks {
            (self.call_back(), " UserCallBack=cb;\n", format!("   if(n=={FIRST_TICK}){{ cbn=0; }}\n"))
        } else {
            (String::new(), "", String::new())
        };
        format!(
            "{HEAD}{head}{call_back}int main(){{ int n,i;\n g=(int*)gather_buffer; r=(double*)(g+{SAMPLES}); m=0; cbn=0; for(i=0;i<{words};i++) g[i]=0;\n{start}{set} Delay_sec(0.003); WaitNextTimeSlice(); T0_=ServoTick;\n for(n=0;n<{count};n++){{\n   WaitNextTimeSlice();\n{reset}{slices}   if(n%{every}==0){{{sample} }}\n }}\n dump(); persist.UserData[0]=1;\n return 0;\n}}\n"
        )
    }

    /// The call-back that records in the servo interrupt.
    fn call_back(&self) -> String {
        let (count, samples) = (self.columns.len(), self.samples());
        let statements: String = self.at(PartKind::Tick).flat_map(|text| [" ", text, "\n"]).collect();
        let columns: String =
            (0..).zip(&self.columns).map(|(at, column)| format!(" r[k_+{at}]={column};")).collect();
        format!(
            "void cb(void){{\n{statements} if(cbn<{samples}){{ k_=cbn*{count};{columns} }}\n cbn=cbn+1;\n}}\n"
        )
    }

    /// The program of a thread that the first one starts.
    fn other(&self, thread: u8) -> String {
        let slices = self.slices_of(thread);
        format!(
            "int main(){{ int n;\n for(n=0;n<{};n++){{\n{slices}   WaitNextTimeSlice();\n }}\n return 0;\n}}\n",
            self.slices
        )
    }
}

impl Part {
    /// The part as one line, with its slice.
    pub(super) fn shown(&self) -> String {
        let text = self.text.lines().next().unwrap_or_default();
        match self.kind {
            PartKind::Line | PartKind::Start => text.to_owned(),
            // The functions are the same in all scenarios of an area.
            PartKind::Head => format!("{text:.60} …"),
            PartKind::Tick => format!("every tick: {text}"),
            PartKind::Slice { thread: 1, slice } => format!("slice {slice}: {text}"),
            PartKind::Slice { thread, slice } => format!("thread {thread}, slice {slice}: {text}"),
        }
    }

    /// The thread in one of whose slices it is executed.
    fn thread(&self) -> Option<u8> {
        match self.kind {
            PartKind::Slice { thread, .. } => Some(thread),
            PartKind::Line | PartKind::Head | PartKind::Start | PartKind::Tick => None,
        }
    }
}
